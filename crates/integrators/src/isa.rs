//! Instruction sets that the loop over samples is compiled for. All run the same operations and give the same bits.

use tyndall_geometry::Dispatch;

/// An instruction set that this processor has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Isa(Set);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Set {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Isa {
    /// The set asked for; `None` when this processor does not have it.
    pub fn choose(dispatch: Dispatch) -> Option<Self> {
        if !dispatch.is_available() {
            return None;
        }
        Some(Self(match dispatch {
            #[cfg(target_arch = "x86_64")]
            Dispatch::Detect if Dispatch::Avx2.is_available() => Set::Avx2,
            #[cfg(target_arch = "x86_64")]
            Dispatch::Avx2 => Set::Avx2,
            #[cfg(target_arch = "x86_64")]
            Dispatch::Avx512 => Set::Avx512,
            _ => Set::Portable,
        }))
    }

    pub(crate) const fn set(self) -> Set {
        self.0
    }
}
