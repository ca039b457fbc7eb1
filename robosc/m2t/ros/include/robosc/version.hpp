// The version of these headers.
#ifndef ROBOSC_VERSION_HPP_
#define ROBOSC_VERSION_HPP_

/// The namespace of all declarations in these headers, with a hash of their contents. One process may load packages
/// generated with different headers, and the linker must not mix their symbols.
#define ROBOSC_VERSION v5c81af27

#endif  // ROBOSC_VERSION_HPP_
