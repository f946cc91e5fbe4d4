//! Boundaries between media that contradict each other.
//!
//! A surface that names media says what lies on either side. Paths from the camera keep track of the medium they are in; a
//! surface that expects another one on the side from which it is met contradicts the surfaces before it: a hole in a
//! boundary, normals that point the wrong way, volumes that overlap, or a camera whose medium is not declared.

use serde::Serialize;
use tyndall_base::{rng::Pcg32, vec::vec2, warp};
use tyndall_geometry::{Frame, Ray};
use tyndall_transport::{
    Interaction, MediumId, Scene, camera::CameraSample, material::Material, scene::Boundary,
};

/// Paths that look for contradictions.
const PATHS: u32 = 4096;
/// Surfaces that a path meets at most.
const BOUNCES: u32 = 24;
/// Contradictions that are told one by one.
const TOLD: usize = 8;

/// What the paths have found.
#[derive(Clone, Debug, Default, Serialize)]
pub struct BoundaryCheck {
    /// Paths from the camera.
    pub paths: u32,
    /// Meetings with surfaces that name media.
    pub crossings: u64,
    /// Those that contradict the path's medium.
    pub contradictions: u64,
    /// The first ones, each pair of media once.
    pub examples: Vec<Contradiction>,
}

/// A surface that expects another medium than the path is in.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contradiction {
    /// Where \[m\].
    pub p: [f32; 3],
    /// Index of the shape.
    pub shape: u32,
    /// The medium that the path is in; `null` for vacuum.
    pub tracked: Option<String>,
    /// The medium that the surface expects.
    pub expected: Option<String>,
}

/// Follows paths through the scene.
pub(super) fn check(scene: &Scene, names: &[String]) -> BoundaryCheck {
    let mut found = BoundaryCheck { paths: PATHS, ..BoundaryCheck::default() };
    if scene.shapes.iter().all(|s| s.boundary.is_none()) {
        return found;
    }
    let mut rng = Pcg32::new(7, 11);
    let [width, height] = scene.camera.resolution();
    for _ in 0..PATHS {
        let film = vec2(rng.next_f32() * width as f32, rng.next_f32() * height as f32);
        let lens = vec2(rng.next_f32(), rng.next_f32());
        let ray = scene.camera.sample_ray(&CameraSample { film, lens, time: 0.0 });
        follow(scene, names, ray, &mut rng, &mut found);
    }
    found
}

fn follow(scene: &Scene, names: &[String], mut ray: Ray, rng: &mut Pcg32, found: &mut BoundaryCheck) {
    let mut medium = scene.camera_medium;
    for _ in 0..BOUNCES {
        let Some(hit) = scene.intersect(&ray) else { return };
        let isect = scene.interaction(&ray, &hit);
        if let Some(boundary) = isect.boundary {
            found.crossings += 1;
            let expected = side(&boundary, isect.surface.ng.dot(ray.d) > 0.0);
            if expected != medium {
                found.contradictions += 1;
                note(found, &isect, hit.shape, names, medium, expected);
            }
        }
        let d = onwards(scene, &isect, &ray, rng);
        medium = isect.medium_towards(d, medium);
        ray = Ray::new(isect.surface.origin(d), d);
    }
}

/// The medium on the side that a ray comes from: inside when it leaves along the normal.
fn side(boundary: &Boundary, leaves: bool) -> MediumId {
    if leaves { boundary.inside } else { boundary.outside }
}

/// Straight on through boundaries and, half of the time, through what transmits; else diffusely back.
fn onwards(scene: &Scene, isect: &Interaction<'_>, ray: &Ray, rng: &mut Pcg32) -> tyndall_base::Vec3 {
    let material = isect.material;
    if material.is_interface() {
        return ray.d;
    }
    let transmits = matches!(
        scene.materials[material.index()],
        Material::Dielectric(_) | Material::ThinDielectric(_) | Material::DiffuseTransmission(_)
    );
    if transmits && rng.next_f32() < 0.5 {
        return ray.d;
    }
    let n = isect.surface.ng;
    let towards = if n.dot(ray.d) < 0.0 { n } else { -n };
    Frame::from_z(towards).from_local(warp::sample_cosine_hemisphere([rng.next_f32(), rng.next_f32()]))
}

fn note(
    found: &mut BoundaryCheck,
    isect: &Interaction<'_>,
    shape: u32,
    names: &[String],
    tracked: MediumId,
    expected: MediumId,
) {
    let name = |id: MediumId| (!id.is_vacuum()).then(|| names[id.index()].clone());
    let (tracked, expected) = (name(tracked), name(expected));
    let known = |e: &Contradiction| e.shape == shape && e.tracked == tracked && e.expected == expected;
    if found.examples.len() < TOLD && !found.examples.iter().any(known) {
        found.examples.push(Contradiction { p: isect.surface.p.to_array(), shape, tracked, expected });
    }
}
