//! The background: two named threads that trace, one for what the window shows next, and one for what takes long and
//! waits meanwhile. The editor drops a request into a mailbox
//! and goes on; the newest wins; finished pictures wait in an outbox. Nothing here knows about windows:
//! `wake` is called whenever there is something to look at.

mod task;

mod budget;

mod frame_pool;

mod jobs;

mod mailbox;

mod shared;

mod live;

mod render_thread;

mod handle;

mod exports;

pub use budget::BUDGET;
pub use handle::{RenderThreadError, Worker};
pub use jobs::{
    Activity, Answer, Event, ExportState, Frame, JobKind, LiveJob, Pace, QueryJob, Question,
    StillJob, ThumbnailJob,
};
pub use task::{Background, NoAnswer, panic_text};
