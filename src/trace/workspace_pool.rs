//! Memory that one piece of a picture leaves for the next: to find it anew costs as much as many rays.

use std::any::Any;
use std::sync::{Mutex, PoisonError};

/// What pieces work with that nobody traces, of a type that only they know: one for each thread at most.
#[derive(Debug, Default)]
pub struct WorkspacePool(Mutex<Vec<Box<dyn Any + Send>>>);

impl WorkspacePool {
    /// Something of this type, if that is there.
    pub fn take<T: Any>(&self) -> Option<Box<T>> {
        let left = self.kept().pop()?;
        left.downcast().ok()
    }

    /// Leaves it for the next piece.
    pub fn put<T: Any + Send>(&self, left: Box<T>) {
        self.kept().push(left);
    }

    fn kept(&self) -> std::sync::MutexGuard<'_, Vec<Box<dyn Any + Send>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_left_is_taken_once() {
        let workspace_pool = WorkspacePool::default();
        assert_eq!(workspace_pool.take::<u32>(), None);
        workspace_pool.put(Box::new(7_u32));
        assert_eq!(workspace_pool.take::<u32>(), Some(Box::new(7)));
        assert_eq!(workspace_pool.take::<u32>(), None);
        workspace_pool.put(Box::new(7_u32));
        assert_eq!(
            workspace_pool.take::<String>(),
            None,
            "it is something else"
        );
    }
}
