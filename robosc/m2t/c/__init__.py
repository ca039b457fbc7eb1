"""The supervisor as C99, shared by all targets that contain it."""
