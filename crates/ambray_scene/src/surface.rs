//! From a hit to the attributes of the surface there.
