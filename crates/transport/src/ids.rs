//! Indices into the scene's tables.

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct $name(pub u32);
        impl $name {
            /// The position in the table.
            #[inline(always)]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}
id!(
    /// A medium of the scene; [`MediumId::VACUUM`] stands for none.
    MediumId
);
id!(
    /// A material of the scene; [`MaterialId::INTERFACE`] stands for a boundary that does not bend light.
    MaterialId
);
id!(
    /// A light of the scene.
    LightId
);

impl MediumId {
    /// No medium.
    pub const VACUUM: Self = Self(u32::MAX);

    /// True for [`Self::VACUUM`].
    #[inline(always)]
    pub const fn is_vacuum(self) -> bool {
        self.0 == u32::MAX
    }
}

impl MaterialId {
    /// No material: light passes unbent.
    pub const INTERFACE: Self = Self(u32::MAX);

    /// True for [`Self::INTERFACE`].
    #[inline(always)]
    pub const fn is_interface(self) -> bool {
        self.0 == u32::MAX
    }
}
