//! Which event a sampled direction belongs to.

use std::ops::BitOr;

/// A set of the bits below.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BsdfFlags(u8);

impl BsdfFlags {
    /// No event at all.
    pub const NONE: Self = Self(0);
    /// `wi` on the side of `wo`.
    pub const REFLECTION: Self = Self(1);
    /// `wi` on the other side.
    pub const TRANSMISSION: Self = Self(2);
    /// Spread over the hemisphere.
    pub const DIFFUSE: Self = Self(4);
    /// Spread around a direction.
    pub const GLOSSY: Self = Self(8);
    /// A single direction: `f` and `pdf` multiply a Dirac delta.
    pub const DELTA: Self = Self(16);

    /// True when every bit of `other` is set.
    #[inline(always)]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// True when any bit of `other` is set.
    #[inline(always)]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// True for a single direction.
    #[inline(always)]
    pub const fn is_delta(self) -> bool {
        self.contains(Self::DELTA)
    }

    /// True on the side of `wo`.
    #[inline(always)]
    pub const fn is_reflection(self) -> bool {
        self.contains(Self::REFLECTION)
    }

    /// True on the other side.
    #[inline(always)]
    pub const fn is_transmission(self) -> bool {
        self.contains(Self::TRANSMISSION)
    }

    /// The union.
    #[inline(always)]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOr for BsdfFlags {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        self.or(other)
    }
}
