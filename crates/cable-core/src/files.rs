//! The only file of the core that touches the file system (placeholder).
