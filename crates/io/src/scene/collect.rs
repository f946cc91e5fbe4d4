//! From directives to flat lists: every shape, light, material ... with the state it was declared under.

use super::state::{AreaLight, GraphicsState, MaterialRef, Moving};
use std::{collections::HashMap, sync::Arc};
use tyndall_geometry::{GeometryError, Transform};
use tyndall_pbrt::{
    AttributeTarget, Diagnostics, Directive, DirectiveKind, Entity, EntityKind, Error, ErrorKind,
    OptionValue, ParamSet, Parser, Place, Text, TextureValue,
};

/// A declaration by class and parameters.
#[derive(Clone, Debug)]
pub struct Declared {
    /// Its class, or the name it defines.
    pub name: Text,
    /// Its parameters.
    pub params: ParamSet,
    /// The transformation it was declared under.
    pub ctm: Moving,
    /// The colour space in force.
    pub color_space: Arc<str>,
}

impl Declared {
    /// The directive that counts where the scene has none: `Film "rgb"`, `Camera "perspective"`.
    pub fn default_of(kind: EntityKind, class: &str) -> Result<Self, Error> {
        let text = format!("{} \"{class}\"", kind.name());
        let mut parser =
            Parser::from_bytes("(default)", text.into_bytes(), std::path::Path::new(""))?.fragment();
        let collected = collect(&mut parser, &Diagnostics::default())?;
        let missing = || Error::in_file(ErrorKind::Other(format!("no default {}", kind.name())), "scene");
        collected.options.get(&kind).cloned().ok_or_else(missing)
    }
}

/// A shape and its state.
#[derive(Clone, Debug)]
pub struct ShapeRecord {
    /// The shape itself.
    pub declared: Declared,
    /// `ReverseOrientation`.
    pub reverse_orientation: bool,
    /// Its material.
    pub material: MaterialRef,
    /// The light it is.
    pub area_light: Option<AreaLight>,
    /// Media inside and outside, if the state named any.
    pub media: Option<(Text, Text)>,
    /// It belongs to an object.
    pub in_object: bool,
}

/// A light source and the medium it stands in.
#[derive(Clone, Debug)]
pub struct LightRecord {
    /// The light.
    pub declared: Declared,
}

/// A texture.
#[derive(Clone, Debug)]
pub struct TextureRecord {
    /// Class, parameters, state.
    pub declared: Declared,
    /// A number or a spectrum.
    pub value: TextureValue,
    /// The name it defines.
    pub defines: Text,
}

/// A use of an object.
#[derive(Clone, Debug)]
pub struct InstanceRecord {
    /// The object's name.
    pub object: Text,
    /// Where it stands.
    pub ctm: Moving,
}

/// A scene's directives, sorted.
#[derive(Debug, Default)]
pub struct Collected {
    /// `Camera`, `Film`, `Sampler`, `Integrator`, `PixelFilter`, `Accelerator`.
    pub options: HashMap<EntityKind, Declared>,
    /// The medium that the camera is in.
    pub camera_medium: Option<Text>,
    /// `Material` directives in order.
    pub materials: Vec<Declared>,
    /// `MakeNamedMaterial`.
    pub named_materials: HashMap<String, Declared>,
    /// `MakeNamedMedium`, in order.
    pub media: Vec<Declared>,
    /// Textures in order.
    pub textures: Vec<TextureRecord>,
    /// Lights but for emitting shapes.
    pub lights: Vec<LightRecord>,
    /// Shapes of the world.
    pub shapes: Vec<ShapeRecord>,
    /// Shapes of objects.
    pub objects: HashMap<String, Vec<ShapeRecord>>,
    /// Objects in the order of their definition.
    pub object_order: Vec<String>,
    /// Uses of objects.
    pub instances: Vec<InstanceRecord>,
    /// `Option` directives: normalised name, value.
    pub globals: Vec<(String, Text, OptionValue)>,
    /// Shutter times of moving transformations.
    pub times: [f64; 2],
    /// The files that the directives stand in.
    pub sources: tyndall_pbrt::SourceMap,
}

impl Collected {
    /// Where a text stands.
    pub fn place(&self, text: &Text) -> Place {
        self.sources.place(text.span())
    }
}

struct Collector<'p> {
    out: Collected,
    state: GraphicsState,
    stack: Vec<GraphicsState>,
    imports: Vec<(GraphicsState, HashMap<String, Moving>)>,
    systems: HashMap<String, Moving>,
    object: Option<String>,
    warnings: &'p Diagnostics,
}

/// Reads all directives of `parser`.
pub fn collect(parser: &mut Parser, warnings: &Diagnostics) -> Result<Collected, Error> {
    let mut c = Collector {
        out: Collected { times: [0.0, 1.0], sources: parser.sources().clone(), ..Collected::default() },
        state: GraphicsState::default(),
        stack: Vec::new(),
        imports: Vec::new(),
        systems: HashMap::new(),
        object: None,
        warnings,
    };
    for directive in parser {
        c.directive(directive?)?;
    }
    Ok(c.out)
}

impl Collector<'_> {
    fn directive(&mut self, directive: Directive) -> Result<(), Error> {
        let place = self.out.sources.place(directive.span);
        let geometry = |e: GeometryError| Error::new(ErrorKind::Other(e.to_string()), place.clone());
        match directive.kind {
            DirectiveKind::Entity(entity) => self.entity(entity, &place)?,
            DirectiveKind::Attribute(target, params) => self.state.add_attribute(target, params),
            DirectiveKind::Texture(t) => {
                let declared = self.declare(t.class, t.params, Some(AttributeTarget::Texture));
                self.out.textures.push(TextureRecord { declared, value: t.value, defines: t.name });
            }
            DirectiveKind::AttributeBegin => self.stack.push(self.state.clone()),
            DirectiveKind::AttributeEnd => self.pop(&place)?,
            DirectiveKind::ObjectBegin(name) => {
                self.stack.push(self.state.clone());
                self.object = Some(name.as_str().to_owned());
                self.out.object_order.push(name.as_str().to_owned());
                self.out.objects.entry(name.as_str().to_owned()).or_default();
            }
            DirectiveKind::ObjectEnd => {
                self.object = None;
                self.pop(&place)?;
            }
            DirectiveKind::ObjectInstance(object) => {
                self.out.instances.push(InstanceRecord { object, ctm: self.state.ctm });
            }
            DirectiveKind::WorldBegin => {
                self.systems.insert("world".into(), Moving::default());
                self.state.begin_world();
            }
            DirectiveKind::ReverseOrientation => {
                self.state.reverse_orientation = !self.state.reverse_orientation;
            }
            DirectiveKind::NamedMaterial(name) => self.state.material = MaterialRef::Named(name),
            DirectiveKind::MediumInterface { interior, exterior } => {
                self.state.media = Some((interior, exterior));
            }
            DirectiveKind::ColorSpace(name) => {
                self.state.color_space = super::color_space::canonical(&name, &place)?;
            }
            DirectiveKind::Option(name, value) => {
                self.out.globals.push((tyndall_pbrt::normalized_option(name.as_str()), name, value));
            }
            DirectiveKind::CoordinateSystem(name) => {
                self.systems.insert(name.as_str().into(), self.state.ctm);
            }
            DirectiveKind::CoordSysTransform(name) => match self.systems.get(name.as_str()) {
                Some(ctm) => self.state.ctm = *ctm,
                None => {
                    let message =
                        format!("no coordinate system \"{}\": the transformation stays", name.as_str());
                    self.warnings.warn(place.clone(), message);
                }
            },
            DirectiveKind::ActiveTransform(active) => self.state.set_active(active),
            DirectiveKind::TransformTimes(times) => self.out.times = times,
            DirectiveKind::ImportBegin(_) => {
                // an import sees the state, but not the named coordinate systems
                self.imports.push((self.state.clone(), std::mem::take(&mut self.systems)));
            }
            DirectiveKind::ImportEnd => {
                if let Some((state, systems)) = self.imports.pop() {
                    (self.state, self.systems) = (state, systems);
                }
            }
            transformation => self.transformation(&transformation).map_err(geometry)?,
        }
        Ok(())
    }

    fn transformation(&mut self, kind: &DirectiveKind) -> Result<(), GeometryError> {
        let local = match *kind {
            DirectiveKind::Identity => return self.state.change(|_| Ok(Transform::IDENTITY)),
            DirectiveKind::Transform(m) => {
                let m = Transform::from_columns(m)?;
                return self.state.change(|_| Ok(m));
            }
            DirectiveKind::ConcatTransform(m) => Transform::from_columns(m)?,
            DirectiveKind::Translate([x, y, z]) => Transform::translate(x, y, z),
            DirectiveKind::Scale([x, y, z]) => Transform::scale(x, y, z)?,
            DirectiveKind::Rotate([degrees, x, y, z]) => Transform::rotate(degrees, [x, y, z])?,
            DirectiveKind::LookAt([ex, ey, ez, lx, ly, lz, ux, uy, uz]) => {
                Transform::look_at([ex, ey, ez], [lx, ly, lz], [ux, uy, uz])?
            }
            // every other kind was handled by the caller
            _ => return Ok(()),
        };
        self.state.change(|ctm| Ok(ctm * local))
    }

    fn pop(&mut self, place: &Place) -> Result<(), Error> {
        let unmatched =
            || Error::new(ErrorKind::Other("AttributeEnd without AttributeBegin".into()), place.clone());
        self.state = self.stack.pop().ok_or_else(unmatched)?;
        Ok(())
    }

    fn declare(&self, name: Text, params: ParamSet, target: Option<AttributeTarget>) -> Declared {
        let params = self.state.complete(params, target);
        Declared { name, params, ctm: self.state.ctm, color_space: self.state.color_space.clone() }
    }

    fn entity(&mut self, entity: Entity, place: &Place) -> Result<(), Error> {
        let Entity { kind, name, params } = entity;
        match kind {
            EntityKind::Shape => {
                let record = self.shape(name, params);
                let list = match &self.object {
                    Some(object) => self.out.objects.entry(object.clone()).or_default(),
                    None => &mut self.out.shapes,
                };
                list.push(record);
            }
            EntityKind::AreaLightSource => {
                let params = self.state.complete(params, Some(AttributeTarget::Light));
                self.state.area_light = Some(AreaLight { class: name, params });
            }
            EntityKind::LightSource => {
                let declared = self.declare(name, params, Some(AttributeTarget::Light));
                self.out.lights.push(LightRecord { declared });
            }
            EntityKind::Material => {
                self.state.material = MaterialRef::Inline(self.out.materials.len());
                let declared = self.declare(name, params, Some(AttributeTarget::Material));
                self.out.materials.push(declared);
            }
            EntityKind::MakeNamedMaterial => {
                let declared = self.declare(name, params, Some(AttributeTarget::Material));
                self.out.named_materials.insert(declared.name.as_str().to_owned(), declared);
            }
            EntityKind::MakeNamedMedium => {
                let declared = self.declare(name, params, Some(AttributeTarget::Medium));
                self.out.media.push(declared);
            }
            EntityKind::Camera
            | EntityKind::Film
            | EntityKind::Sampler
            | EntityKind::Integrator
            | EntityKind::PixelFilter
            | EntityKind::Accelerator => self.option(kind, name, params, place),
        }
        Ok(())
    }

    fn option(&mut self, kind: EntityKind, name: Text, params: ParamSet, place: &Place) {
        let declared = self.declare(name, params, None);
        if kind == EntityKind::Camera {
            // camera space is where the current transformation maps the world to
            let to_world = |t: Transform| t.inverse();
            let camera = Moving { start: to_world(self.state.ctm.start), end: to_world(self.state.ctm.end) };
            self.systems.insert("camera".into(), camera);
            self.out.camera_medium = self.state.media.as_ref().map(|(_, outside)| outside.clone());
        }
        if self.out.options.insert(kind, declared).is_some() {
            self.warnings.warn(place.clone(), format!("{} given twice: the last one counts", kind.name()));
        }
    }

    fn shape(&self, name: Text, params: ParamSet) -> ShapeRecord {
        ShapeRecord {
            declared: self.declare(name, params, Some(AttributeTarget::Shape)),
            reverse_orientation: self.state.reverse_orientation,
            material: self.state.material.clone(),
            area_light: self.state.area_light.clone(),
            media: self.state.media.clone(),
            in_object: self.object.is_some(),
        }
    }
}
