// The version of these headers.
#ifndef ROBOSC_VERSION_HPP_
#define ROBOSC_VERSION_HPP_

/// The namespace of all that these headers declare, named for what stands in them: one process may load packages that
/// were generated with others, and the linker must take nothing of one for the other's.
#define ROBOSC_VERSION v3397ac79

#endif  // ROBOSC_VERSION_HPP_
