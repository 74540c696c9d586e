//! Background work: two named render threads, one for what the window shows next, and one for work that takes long,
//! which is paused meanwhile. The editor puts requests into a mailbox and goes on, the newest live request replacing
//! older ones; finished pictures wait in an outbox. Nothing here depends on windows: the callback `wake` is called
//! whenever there is something to fetch.

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
