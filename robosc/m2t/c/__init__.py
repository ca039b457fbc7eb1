"""The supervisor as C99: what the targets that contain it share."""
