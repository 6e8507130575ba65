//! Names, files and problems of new projects.
