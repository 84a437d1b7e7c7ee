//! The glTF loader: right files, and wrong and hostile ones.

mod documents;
mod hostile;
mod right;
mod surfaces;
