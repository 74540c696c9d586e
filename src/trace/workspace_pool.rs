//! Memory that one piece of a picture leaves for the next: allocating it anew costs as much as many rays.

use std::any::Any;
use std::sync::{Mutex, PoisonError};

/// Memory that no piece is using, of a type that only the pieces know; one for each thread at most.
#[derive(Debug, Default)]
pub struct WorkspacePool(Mutex<Vec<Box<dyn Any + Send>>>);

impl WorkspacePool {
    /// Takes what was left last; `None` if there is nothing, or something of another type.
    pub fn take<T: Any>(&self) -> Option<Box<T>> {
        let workspace = self.lock().pop()?;
        workspace.downcast().ok()
    }

    /// Leaves memory for the next piece.
    pub fn put<T: Any + Send>(&self, workspace: Box<T>) {
        self.lock().push(workspace);
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<Box<dyn Any + Send>>> {
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
