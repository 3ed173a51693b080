//! Large lists. That there is no memory for one is an error, where Rust would end the program.

/// There is no memory for a large list.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("no memory for a list of {bytes} bytes; ask for less, or free memory")]
pub struct OutOfMemory {
    /// Size of the list.
    pub bytes: u64,
}

/// Makes room for `more` elements behind those of `list`; as `Vec::reserve`, it may take more so as not to be asked often.
#[inline]
pub(crate) fn reserve<T>(list: &mut Vec<T>, more: usize) -> Result<(), OutOfMemory> {
    if list.capacity() - list.len() >= more {
        return Ok(());
    }
    grow(list, more)
}

#[cold]
fn grow<T>(list: &mut Vec<T>, more: usize) -> Result<(), OutOfMemory> {
    let bytes = (list.len() as u64).saturating_add(more as u64).saturating_mul(size_of::<T>() as u64);
    list.try_reserve(more).map_err(|_| OutOfMemory { bytes })
}

/// An empty list with room for `count` elements.
pub(crate) fn room<T>(count: usize) -> Result<Vec<T>, OutOfMemory> {
    let mut list = Vec::new();
    let bytes = (count as u64).saturating_mul(size_of::<T>() as u64);
    list.try_reserve_exact(count).map_err(|_| OutOfMemory { bytes })?;
    Ok(list)
}

/// A list of `count` times `value`.
pub(crate) fn filled<T: Clone>(count: usize, value: T) -> Result<Vec<T>, OutOfMemory> {
    let mut list = room(count)?;
    list.resize(count, value);
    Ok(list)
}

/// A copy of `list`.
pub(crate) fn copied<T: Copy>(list: &[T]) -> Result<Vec<T>, OutOfMemory> {
    let mut copy = room(list.len())?;
    copy.extend_from_slice(list);
    Ok(copy)
}

/// The elements of `all`, about `count`.
pub(crate) fn collected<T>(count: usize, all: impl Iterator<Item = T>) -> Result<Vec<T>, OutOfMemory> {
    let mut list = room(count)?;
    for element in all {
        reserve(&mut list, 1)?;
        list.push(element);
    }
    Ok(list)
}

/// Ends the program, as Rust does where a list finds no memory.
pub(crate) fn give_up(error: OutOfMemory) -> ! {
    let layout =
        usize::try_from(error.bytes).ok().and_then(|bytes| std::alloc::Layout::array::<u8>(bytes).ok());
    std::alloc::handle_alloc_error(layout.unwrap_or(std::alloc::Layout::new::<u8>()))
}
