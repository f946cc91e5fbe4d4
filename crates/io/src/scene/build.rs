//! From collected directives to the scene.

use super::{
    LoadOptions, LoadedScene, camera,
    collect::{Collected, Declared, ShapeRecord},
    context::{Context, at},
    degenerate,
    emission::Units,
    film, light,
    material::Materials,
    medium, render, shape,
    texture::Textures,
};
use std::{collections::HashMap, sync::Arc, time::Instant};
use tyndall_geometry::{Accel, BuildOptions, InstanceDesc, Motion, Shape, ShapeGroup};
use tyndall_pbrt::{EntityKind, Error, ErrorKind, Inventory, SourceMap, Text};
use tyndall_spectral::{Emission, LambdaRange, cie};
use tyndall_transport::{
    LightId, MaterialId, MediumId, Scene, ShapeBinding,
    light::{AreaExtra, AreaLight, Light, LightSet},
    material::Material,
    media::Medium,
    scene::{BOUNDARY, Boundary, OPAQUE},
    texture::FloatTexture,
    touching::may_touch,
};

/// Media by name.
struct Media {
    table: Vec<Medium>,
    ids: HashMap<String, MediumId>,
    names: Vec<String>,
    /// What shapes of a material are filled with, by material.
    fillings: HashMap<u32, MediumId>,
    /// What shapes without a medium interface are in.
    around: Option<Text>,
    /// Where names stand.
    sources: SourceMap,
    /// pbrt's `path` leaves media out.
    ignored: bool,
}

impl Media {
    fn new(
        ctx: &Context<'_>,
        collected: &Collected,
        units: &mut Units,
        fillings: &HashMap<u32, Medium>,
        ignored: bool,
    ) -> Result<Self, Error> {
        let mut media = Self {
            table: Vec::new(),
            ids: HashMap::new(),
            names: Vec::new(),
            fillings: HashMap::new(),
            around: collected.camera_medium.clone(),
            sources: collected.sources.clone(),
            ignored,
        };
        for declared in &collected.media {
            let name = declared.name.as_str().to_owned();
            let known = |n: &str| media.ids.get(n).map(|id| &media.table[id.index()]);
            let medium = medium::medium(ctx, declared, units, &known)?;
            media.ids.insert(name.clone(), MediumId(media.table.len() as u32));
            media.table.push(medium);
            media.names.push(name);
        }
        let mut sorted: Vec<_> = fillings.iter().collect();
        sorted.sort_by_key(|f| *f.0);
        for (material, medium) in sorted {
            media.fillings.insert(*material, MediumId(media.table.len() as u32));
            media.table.push(medium.clone());
            media.names.push(format!("subsurface of material {material}"));
        }
        Ok(media)
    }

    fn find(&self, name: &Text) -> Result<MediumId, Error> {
        if name.as_str().is_empty() {
            return Ok(MediumId::VACUUM);
        }
        let id = self.ids.get(name.as_str()).copied().ok_or_else(|| {
            let message = format!("MediumInterface: no medium is named \"{}\"", name.as_str());
            let e = Error::new(ErrorKind::Other(message), self.sources.place(name.span()));
            match tyndall_pbrt::did_you_mean(name.as_str(), self.ids.keys().map(String::as_str)) {
                Some(hint) => e.hint(hint),
                None => e.hint("media are defined by MakeNamedMedium"),
            }
        })?;
        Ok(if self.ignored { MediumId::VACUUM } else { id })
    }

    fn boundary(&self, record: &ShapeRecord, material: MaterialId) -> Result<Option<Boundary>, Error> {
        if let Some(&inside) = self.fillings.get(&material.0) {
            // the material says what is inside, whatever pbrt's surrogate would have there
            let outside = record.media.as_ref().map(|m| &m.1).or(self.around.as_ref());
            let outside = outside.map_or(Ok(MediumId::VACUUM), |name| self.find(name))?;
            return Ok(Some(Boundary { inside, outside }));
        }
        let Some((inside, outside)) = &record.media else { return Ok(None) };
        let (inside, outside) = (self.find(inside)?, self.find(outside)?);
        Ok((inside != outside).then_some(Boundary { inside, outside }))
    }
}

/// What shapes refer to.
type Bound<'b, 't> = (&'b Textures<'t>, &'b Materials, &'b Media);

/// Shape groups with what is bound to them; area lights come later, when areas are known.
struct Groups<'a> {
    groups: Vec<ShapeGroup>,
    bindings: Vec<ShapeBinding>,
    /// The record of each group.
    records: Vec<&'a ShapeRecord>,
}

impl<'a> Groups<'a> {
    fn add(
        &mut self,
        ctx: &Context<'_>,
        record: &'a ShapeRecord,
        (textures, materials, media): Bound<'_, '_>,
    ) -> Result<std::ops::Range<u32>, Error> {
        let first = self.groups.len() as u32;
        let params = &record.declared.params;
        let alpha = textures.float(params, "alpha")?.filter(|a| a.constant().is_none_or(|v| v < 1.0));
        let material = materials.find(&record.material, params)?;
        let boundary = media.boundary(record, material)?;
        for shape in shape::shapes(ctx, record, textures)? {
            // quadrics carry their transform, meshes come transformed: orientation is the same for both
            let group = ShapeGroup {
                shape,
                reverse_orientation: record.reverse_orientation,
                transform_swaps_handedness: shape::placement(record).swaps_handedness(),
                mask: if material.is_interface() { BOUNDARY } else { OPAQUE },
            };
            self.groups.push(group);
            self.bindings.push(ShapeBinding { material, boundary, first_light: None, alpha: alpha.clone() });
            self.records.push(record);
        }
        Ok(first..self.groups.len() as u32)
    }
}

/// Makes everything; `hash`, `diagnostics` and the loading time are the caller's to fill in.
pub fn build(
    ctx: &Context<'_>,
    collected: &Collected,
    options: &LoadOptions,
    inventory: Inventory,
) -> Result<LoadedScene, Error> {
    let integrator = integrator(ctx, collected, options)?;
    let sampler = render::sampler(ctx, collected)?;
    let filter = film::filter(ctx, collected.options.get(&EntityKind::PixelFilter))?;
    let default_film = Declared::default_of(EntityKind::Film, "rgb")?;
    let declared_film = collected.options.get(&EntityKind::Film).unwrap_or(&default_film);
    let default_camera = Declared::default_of(EntityKind::Camera, "perspective")?;
    let declared_camera = collected.options.get(&EntityKind::Camera).unwrap_or(&default_camera);
    let (camera, shutter) = camera::camera(ctx, declared_camera, collected.times, declared_film)?;
    let film = film::film(ctx, declared_film, shutter[1] - shutter[0])?;
    if let Some(accelerator) = collected.options.get(&EntityKind::Accelerator) {
        accelerator.params.ignore_rest("there is one acceleration structure");
    }

    let mut units = Units::default();
    let textures = Textures::new(*ctx, collected);
    let materials = Materials::new(ctx, collected, &textures)?;
    let media = Media::new(ctx, collected, &mut units, &materials.fillings, integrator.ignores_media)?;
    let mut lights = light::lights(ctx, collected, &mut units)?;

    // shapes of the world, then those of objects
    let bound = (&textures, &materials, &media);
    let mut groups = Groups { groups: Vec::new(), bindings: Vec::new(), records: Vec::new() };
    for record in collected.shapes.iter().filter(|r| !shape::is_carried(r)) {
        groups.add(ctx, record, bound)?;
    }
    let world = groups.groups.len();
    let times = fractions(collected.times, shutter);
    let (objects, instances) = instances(ctx, collected, times, &mut groups, bound)?;

    let start = Instant::now();
    let accel =
        Accel::build(groups.groups, &objects, instances, &BuildOptions { dispatch: options.dispatch })
            .map_err(|e| shape_error(&groups.records, e))?;
    let build_seconds = start.elapsed().as_secs_f64();
    degenerate::check(ctx, &groups.records, &accel)?;

    for (index, record) in groups.records.iter().enumerate() {
        let binding = &mut groups.bindings[index];
        binding.first_light =
            area_lights(ctx, record, index, index < world, binding, &accel, &mut lights, &mut units)?;
    }
    if units.normalised && units.absolute {
        ctx.warnings.warn_without_place(
            "some emitters are absolute and some normalised by pbrt's rule: their ratio has no meaning",
        );
    }
    let camera_medium = match &collected.camera_medium {
        Some(name) => media.find(name)?,
        None => MediumId::VACUUM,
    };
    textures.check_all()?;
    let (_, radius) = accel.bounds().bounding_sphere();
    let weigh = |e: &Emission| visible_power(e, ctx.range);
    let which = integrator.lights.media;
    lights.extend(light::volumes(&media.table, &media.names, &groups.bindings, camera_medium, which)?);
    let lights = LightSet::new(lights, radius, &weigh).choosing(integrator.lights, &accel, radius, &weigh);
    let stats = accel.stats();
    let has_alpha = groups.bindings.iter().any(|b| b.alpha.is_some());
    let has_boundaries = groups.bindings.iter().any(|b| b.material.is_interface());
    let has_touching_boundaries = has_boundaries && may_touch(&accel, &groups.bindings, world);
    let scene = Scene {
        accel,
        has_boundaries,
        has_touching_boundaries,
        has_alpha,
        has_mixes: materials.table.iter().any(|m| matches!(m, Material::Mix(_))),
        has_bumps: materials.table.iter().any(Material::is_bumped),
        guiding: None,
        shapes: groups.bindings,
        materials: materials.table,
        media: media.table,
        lights,
        camera,
        camera_medium,
    };
    Ok(LoadedScene {
        scene,
        film,
        filter,
        sampler,
        integrator,
        units,
        media: media.names,
        inventory,
        sources: SourceMap::default(),
        diagnostics: Arc::default(),
        hash: String::new(),
        stats,
        seconds: [0.0, build_seconds],
    })
}

fn integrator(
    ctx: &Context<'_>,
    collected: &Collected,
    options: &LoadOptions,
) -> Result<render::IntegratorDescription, Error> {
    let declared = collected.options.get(&EntityKind::Integrator);
    let Some(name) = &options.integrator else { return render::integrator(ctx, declared) };
    let Some((method, ignores_media)) = render::integrator_named(name) else {
        let message = format!("--integrator: expected {}, got \"{name}\"", render::INTEGRATORS);
        return Err(Error::in_file(ErrorKind::Other(message), "command line"));
    };
    // the scene's parameters still count
    let renamed = declared.map(|d| Declared { name: Text::new(name.as_str(), d.name.span()), ..d.clone() });
    let mut found = render::integrator(ctx, renamed.as_ref())?;
    (found.name, found.method, found.ignores_media) = (name.clone(), method, ignores_media);
    if declared.is_none() {
        found.settings = render::default_settings(method);
    }
    Ok(found)
}

fn instances<'a>(
    ctx: &Context<'_>,
    collected: &'a Collected,
    times: [f64; 2],
    groups: &mut Groups<'a>,
    bound: Bound<'_, '_>,
) -> Result<(Vec<Vec<u32>>, Vec<InstanceDesc>), Error> {
    let mut objects = Vec::new();
    let mut ids = HashMap::new();
    for name in &collected.object_order {
        let mut members = Vec::new();
        for record in &collected.objects[name] {
            members.extend(groups.add(ctx, record, bound)?);
        }
        ids.insert(name.as_str(), objects.len() as u32);
        objects.push(members);
    }
    let mut placed = Vec::new();
    for instance in &collected.instances {
        let name = instance.object.as_str();
        let place = || collected.place(&instance.object);
        let Some(&object) = ids.get(name) else {
            let message = format!("ObjectInstance: no object is named \"{name}\"");
            let e = Error::new(ErrorKind::Other(message), place());
            return Err(match tyndall_pbrt::did_you_mean(name, ids.keys().copied()) {
                Some(hint) => e.hint(hint),
                None => e,
            });
        };
        let motion = moving(&instance.ctm, times)
            .map_err(|e| Error::new(ErrorKind::Other(format!("ObjectInstance: {e}")), place()))?;
        placed.push(InstanceDesc { object, to_world: instance.ctm.start, motion });
    }
    // a shape that moves is an object of its own, placed once
    for record in collected.shapes.iter().filter(|r| shape::is_carried(r)) {
        let members = groups.add(ctx, record, bound)?.collect();
        let ctm = &record.declared.ctm;
        let motion = moving(ctm, times).map_err(|e| at(&record.declared.params, e))?;
        placed.push(InstanceDesc { object: objects.len() as u32, to_world: ctm.start, motion });
        objects.push(members);
    }
    Ok((objects, placed))
}

/// Times of moving transformations as fractions of the time that the shutter is open.
pub(super) fn fractions(times: [f64; 2], shutter: [f64; 2]) -> [f64; 2] {
    times.map(|t| (t - shutter[0]) / (shutter[1] - shutter[0]))
}

/// The motion of a transformation, if it moves.
pub(super) fn moving(
    ctm: &super::state::Moving,
    times: [f64; 2],
) -> Result<Option<Box<Motion>>, tyndall_geometry::GeometryError> {
    if !ctm.moves() {
        return Ok(None);
    }
    Motion::new(ctm.start, ctm.end, times).map(|m| Some(Box::new(m)))
}

/// The lights of an emitting shape, one a primitive; the first one's id.
#[expect(clippy::too_many_arguments, reason = "one shape of the loop above")]
fn area_lights(
    ctx: &Context<'_>,
    record: &ShapeRecord,
    group: usize,
    in_world: bool,
    binding: &ShapeBinding,
    accel: &Accel,
    lights: &mut Vec<Light>,
    units: &mut Units,
) -> Result<Option<LightId>, Error> {
    let Some(area) = &record.area_light else { return Ok(None) };
    let place = record.declared.params.place();
    if !in_world {
        ctx.warnings.warn(place, "shapes of objects do not emit, as in pbrt: the area light is left out");
        return Ok(None);
    }
    if binding.material.is_interface() {
        ctx.warnings.warn(place, "a shape with the interface material does not emit, as in pbrt");
        return Ok(None);
    }
    let shape = group as u32;
    if matches!(accel.group(shape).shape, Shape::Curves(_)) {
        return Err(record.declared.params.error("curves cannot be area lights, as in pbrt"));
    }
    let prims = accel.group(shape).shape.prim_count() as u32;
    let areas: Vec<f32> = (0..prims).map(|prim| accel.group(shape).area(prim)).collect();
    let total: f64 = areas.iter().map(|a| f64::from(*a)).sum();
    let made = light::area(ctx, area, &record.declared.color_space, total, units)?;
    let invisible = binding.alpha.as_ref().and_then(FloatTexture::constant).is_some_and(|a| a <= 0.0);
    let alpha = binding.alpha.clone().filter(|_| !invisible);
    let rare = made.image.is_some() || alpha.is_some() || invisible;
    let extra = rare.then(|| Arc::new(AreaExtra { image: made.image, alpha, invisible }));
    let first = LightId(lights.len() as u32);
    let light = |(prim, &area): (usize, &f32)| {
        let (emission, extra) = (made.emission.clone(), extra.clone());
        Light::Area(AreaLight { shape, prim: prim as u32, area, emission, two_sided: made.two_sided, extra })
    };
    lights.extend(areas.iter().enumerate().map(light));
    Ok(Some(first))
}

/// Power that the eye sees and, in half the weight, power at all: a light beyond the eye still counts for bands.
fn visible_power(emission: &Emission, range: LambdaRange) -> f64 {
    let width = f64::from(range.width());
    let steps = width.ceil().max(1.0) as usize;
    let weight = |l: f32| {
        let seen: f32 = cie::matching_functions().iter().map(|c| c.eval(l)).sum();
        f64::from(seen) / 320.0 + 0.5 / width
    };
    let at = |i: usize| range.min + range.width() * (i as f32 + 0.5) / steps as f32;
    let continuum: f64 =
        (0..steps).map(|i| weight(at(i)) * f64::from(emission.continuum().eval(at(i)))).sum();
    let lines: f64 = emission.lines().iter().map(|l| weight(l.lambda) * f64::from(l.power)).sum();
    continuum * width / steps as f64 + lines
}

/// The mistake of a shape, at its directive.
fn shape_error(records: &[&ShapeRecord], e: tyndall_geometry::GeometryError) -> Error {
    let group = match &e {
        tyndall_geometry::GeometryError::BadCoordinate { place, .. }
        | tyndall_geometry::GeometryError::IndexOutOfRange { place, .. } => place.group,
        _ => None,
    };
    match group.and_then(|g| records.get(g as usize)) {
        Some(record) => at(&record.declared.params, e),
        None => Error::in_file(ErrorKind::Other(e.to_string()), "scene"),
    }
}
