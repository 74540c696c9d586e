//! Atomic writing of files, and other file operations that all modules share.

mod paths;
mod reading;
mod writing;

mod backups;

pub use backups::replace;
pub use paths::{absolute, has_ending, is_missing, is_same_file, stays_inside, with_separators};
pub use reading::{Marks, Stamp, file_marks, open_file, read_at_most, read_file, time_of};
pub use writing::{
    NewFile, UNFINISHED, make_folder, remove_leftovers, remove_oldest, without_path, write_atomic,
};
