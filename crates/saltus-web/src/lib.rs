//! The computations of the page `saltus.html`: one question, one answer, over bytes.
//!
//! A message is the length of its JSON (four bytes, the lowest first), the JSON, and bytes whose
//! lengths are in the JSON. The page calls [`room`], writes its question there, calls [`answer`]
//! for the length of the answer, and reads that at [`place`]. `docs/use/page.md` lists the
//! questions.
//!
//! Three functions need no generated bindings, and so neither a tool to make them nor the script
//! that comes with them. Nothing is read or written through a pointer on this side.

mod answer;
mod ask;
mod fit;
mod knob;
mod scene;

use std::sync::{Mutex, MutexGuard, PoisonError};

pub use ask::answered;

/// The question, and then its answer.
static MESSAGE: Mutex<Vec<u8>> = Mutex::new(Vec::new());

fn message() -> MutexGuard<'static, Vec<u8>> {
    MESSAGE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes room for a question of `length` bytes and returns its address.
#[allow(unsafe_code)] // an exported name: no other function has it
#[unsafe(no_mangle)]
pub extern "C" fn room(length: usize) -> *mut u8 {
    let mut message = message();
    *message = vec![0; length];
    message.as_mut_ptr()
}

/// Answers the question and returns the length of the answer.
#[allow(unsafe_code)] // as above
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    let mut message = message();
    *message = answered(&message);
    message.len()
}

/// The address of the answer.
#[allow(unsafe_code)] // as above
#[unsafe(no_mangle)]
pub extern "C" fn place() -> *const u8 {
    message().as_ptr()
}
