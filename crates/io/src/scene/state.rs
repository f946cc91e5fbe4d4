//! The graphics state of pbrt's format: what a directive leaves behind for those that follow.

use std::{collections::HashMap, sync::Arc};
use tyndall_geometry::{GeometryError, Transform};
use tyndall_pbrt::{ActiveTransform, AttributeTarget, ParamSet, Text};

/// The transformation at the start and the end of the shutter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moving {
    /// At the shutter's start.
    pub start: Transform,
    /// At the shutter's end.
    pub end: Transform,
}

impl Moving {
    /// True when the two differ.
    pub fn moves(&self) -> bool {
        self.start != self.end
    }
}

/// The material of later shapes.
#[derive(Clone, Debug)]
pub enum MaterialRef {
    /// The `n`-th `Material` directive.
    Inline(usize),
    /// A named one.
    Named(Text),
    /// pbrt's default: diffuse with reflectance 0.5.
    Default,
}

/// An area light that later shapes become.
#[derive(Clone, Debug)]
pub struct AreaLight {
    /// The light's class.
    pub class: Text,
    /// Its parameters.
    pub params: ParamSet,
}

/// Everything that `AttributeBegin` saves.
#[derive(Clone, Debug)]
pub struct GraphicsState {
    /// Current transformation.
    pub ctm: Moving,
    active: ActiveTransform,
    /// `ReverseOrientation` was given an odd number of times.
    pub reverse_orientation: bool,
    /// Material.
    pub material: MaterialRef,
    /// Area light.
    pub area_light: Option<AreaLight>,
    /// Medium inside and outside of later shapes.
    pub media: Option<(Text, Text)>,
    /// Colour space of `rgb` parameters.
    pub color_space: Arc<str>,
    attributes: HashMap<AttributeTarget, Vec<ParamSet>>,
}

impl Default for GraphicsState {
    fn default() -> Self {
        Self {
            ctm: Moving::default(),
            active: ActiveTransform::All,
            reverse_orientation: false,
            material: MaterialRef::Default,
            area_light: None,
            media: None,
            color_space: "srgb".into(),
            attributes: HashMap::new(),
        }
    }
}

impl GraphicsState {
    /// Which of the two transformations later directives change.
    pub fn set_active(&mut self, active: ActiveTransform) {
        self.active = active;
    }

    /// Replaces the active transformations by `f` of themselves.
    pub fn change(
        &mut self,
        f: impl Fn(Transform) -> Result<Transform, GeometryError>,
    ) -> Result<(), GeometryError> {
        if self.active != ActiveTransform::EndTime {
            self.ctm.start = f(self.ctm.start)?;
        }
        if self.active != ActiveTransform::StartTime {
            self.ctm.end = f(self.ctm.end)?;
        }
        Ok(())
    }

    /// `Attribute "target" ...`
    pub fn add_attribute(&mut self, target: AttributeTarget, params: ParamSet) {
        self.attributes.entry(target).or_default().push(params);
    }

    /// A directive's parameters with the attributes of its target and the colour space in force.
    pub fn complete(&self, mut params: ParamSet, target: Option<AttributeTarget>) -> ParamSet {
        for inherited in target.iter().flat_map(|t| self.attributes.get(t)).flatten().rev() {
            params.inherit(inherited);
        }
        params.set_color_space(&self.color_space);
        params
    }

    /// What `WorldBegin` resets.
    pub fn begin_world(&mut self) {
        self.ctm = Moving::default();
        self.active = ActiveTransform::All;
    }
}
