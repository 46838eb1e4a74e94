//! Small programs that end in a picture: see the files beside this package.
