//! Immutable arrays, the large ones on 2 MiB pages: a traversal of a large tree spends a good part of its time on
//! page-table walks otherwise.

use bytemuck::Pod;
use memmap2::MmapMut;
use std::ops::Deref;
use std::ptr::NonNull;

const HUGE_PAGE: usize = 2 << 20;

/// An immutable array.
#[derive(Debug)]
pub(crate) struct Store<T> {
    first: NonNull<T>,
    len: usize,
    /// What `first` points into; neither moves its contents when it is moved.
    _owner: Owner<T>,
}

#[derive(Debug)]
#[expect(dead_code, reason = "held for their memory only")]
enum Owner<T> {
    Heap(Vec<T>),
    Pages(MmapMut),
}

// SAFETY: a Store is a read-only slice together with the owner of its memory; both owners may be sent and shared.
unsafe impl<T: Send + Sync> Send for Store<T> {}
// SAFETY: as above; no interior mutability is reachable.
unsafe impl<T: Send + Sync> Sync for Store<T> {}

impl<T: Pod> Store<T> {
    /// Takes `items`, copied to huge pages when there are several pages' worth and the system grants them.
    pub fn new(items: Vec<T>) -> Self {
        let bytes = size_of_val(items.as_slice());
        let pages = if bytes >= 2 * HUGE_PAGE { Self::on_pages(&items) } else { None };
        pages.unwrap_or_else(|| Self::on_heap(items))
    }

    fn on_heap(items: Vec<T>) -> Self {
        Self { first: NonNull::from(items.as_slice()).cast(), len: items.len(), _owner: Owner::Heap(items) }
    }

    /// Huge pages are a matter of speed only: where the system refuses, the heap does.
    fn on_pages(items: &[T]) -> Option<Self> {
        let bytes = size_of_val(items);
        let mut map = MmapMut::map_anon(bytes + HUGE_PAGE).ok()?;
        #[cfg(target_os = "linux")]
        map.advise(memmap2::Advice::HugePage).ok()?;
        let start = map.as_ptr().align_offset(HUGE_PAGE);
        let room: &mut [T] = bytemuck::try_cast_slice_mut(map.get_mut(start..start + bytes)?).ok()?;
        room.copy_from_slice(items);
        Some(Self { first: NonNull::from(&*room).cast(), len: items.len(), _owner: Owner::Pages(map) })
    }
}

impl<T> Deref for Store<T> {
    type Target = [T];
    #[inline(always)]
    fn deref(&self) -> &[T] {
        // SAFETY: `first` points at `len` initialised values inside the owner, which lives as long as `self` and is
        // never written again.
        unsafe { std::slice::from_raw_parts(self.first.as_ptr(), self.len) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_and_large_arrays_read_back() {
        for n in [0usize, 1, 1000, 3 << 20] {
            let items: Vec<u32> = (0..n as u32).map(|i| i.wrapping_mul(2_654_435_761)).collect();
            let store = Store::new(items.clone());
            assert!(*store == items[..]);
        }
    }
}
