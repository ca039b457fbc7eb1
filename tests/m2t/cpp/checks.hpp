// Common code of the programs that check shared headers: it prints each fault with its line and counts faults.
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
