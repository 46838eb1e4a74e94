//! Small programs that end in a picture: see the files beside this one, and run them with `cargo run --example NAME`.
