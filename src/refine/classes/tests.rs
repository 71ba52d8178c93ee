//! Laws of classes.
