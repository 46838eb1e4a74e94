//! Holds the documentation tests of the pages in the project.
