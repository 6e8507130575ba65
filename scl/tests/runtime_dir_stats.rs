//! Stats files: read while they are written, after a crash, and when they are garbage.
