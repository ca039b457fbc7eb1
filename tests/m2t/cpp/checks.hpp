// What the programs of this folder that check shared headers have in common: a fault is printed with its line, and counted.
#ifndef CHECKS_HPP_
#define CHECKS_HPP_

#include <iostream>

inline int faults = 0;

#define CHECK(condition)                                         \
  do {                                                           \
    if (!(condition)) {                                          \
      std::cout << __LINE__ << ": " << #condition << std::endl; \
      ++faults;                                                  \
    }                                                            \
  } while (false)

#endif  // CHECKS_HPP_
