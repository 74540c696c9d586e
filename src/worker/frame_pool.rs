//! A pool of live pictures: the memory of those that are no longer shown is reused.

use std::sync::Arc;

use crate::image::Image;

/// Most pictures in the pool: one on screen, one on its way there, one being traced.
const MAX_POOL_SIZE: usize = 3;

/// The most recent live pictures.
#[derive(Debug, Default)]
pub struct FramePool {
    handed_out: Vec<Arc<Image>>,
}

impl FramePool {
    /// A picture of this size to trace into; its pixels are unspecified.
    pub fn canvas(&mut self, width: usize, height: usize) -> Image {
        let free = self
            .handed_out
            .iter()
            .position(|image| Arc::strong_count(image) == 1);
        let old = free.and_then(|index| Arc::into_inner(self.handed_out.swap_remove(index)));
        let mut image = old.unwrap_or_default();
        image.resize(width, height);
        image
    }

    /// Hands a picture out; its memory is reused once the last viewer has dropped it.
    pub fn hand_out(&mut self, image: Image) -> Arc<Image> {
        let image = Arc::new(image);
        if self.handed_out.len() == MAX_POOL_SIZE {
            self.handed_out.remove(0);
        }
        self.handed_out.push(Arc::clone(&image));
        image
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_painted_over_when_nobody_looks_at_it() {
        let mut frame_pool = FramePool::default();
        let first = frame_pool.canvas(30, 20);
        let memory = first.pixels.as_ptr();
        let shown = frame_pool.hand_out(first);
        let second = frame_pool.canvas(30, 20);
        assert_ne!(second.pixels.as_ptr(), memory, "the first is looked at");
        drop(shown);
        let third = frame_pool.canvas(20, 20);
        assert_eq!(third.pixels.as_ptr(), memory);
        assert_eq!(third.pixels.len(), 400);
        let keep: Vec<_> = (0..9)
            .map(|_| frame_pool.hand_out(Image::new(1, 1)))
            .collect();
        assert_eq!(frame_pool.handed_out.len(), MAX_POOL_SIZE, "{}", keep.len());
    }
}
