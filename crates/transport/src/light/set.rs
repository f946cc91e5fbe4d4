//! All lights of a scene and the choice among them: in proportion to power, with a floor for the weak, or with a tree
//! over those of finite extent that knows where they are.

use super::{Light, VolumeLight, bounds::LightBounds, tree::LightTree};
use crate::ids::{LightId, MediumId};
use tyndall_base::{Vec3, distribution::Alias};
use tyndall_geometry::Accel;
use tyndall_spectral::Emission;

/// Share of the choice that ignores power, so that a light whose power the weights misjudge is still found.
const UNIFORM_SHARE: f64 = 0.02;

/// With fewer lights of finite extent than this a tree does not pay, unless there are others at infinity.
const FEW: usize = 3;

/// With more lights than this it costs too much to sample each.
const FEW_TO_SAMPLE: usize = 4;

/// Share that lights at infinity, and the others, have at least where both send light: either may be hidden.
const LEAST: f32 = 0.15;

/// How lights are chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// By what they may send to the point that is lit.
    #[default]
    Tree,
    /// By power.
    Power,
    /// All alike.
    Uniform,
}

/// Which media that emit are lights, too; see [`VolumeLight`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MediumLights {
    /// None.
    Off,
    /// For points that it looks small from.
    #[default]
    Auto,
    /// For all points.
    Always,
}

/// Which skies light sampling draws directions to, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Skies {
    /// What chance does not find as well: in images what is above the mean; skies of one radiance from surfaces alone, beside other
    /// lights only from a path's first surface, if each light is sampled there. In a medium any direction will do, and the sum of
    /// what each of many scatterings samples of such a sky varies more than whether the path gets there; at a surface the choice
    /// between sky and lamp varies.
    #[default]
    Auto,
    /// All of them, by radiance.
    Always,
}

/// How lights are sampled.
#[derive(Clone, Copy, Debug)]
pub struct LightRules {
    /// How they are chosen.
    pub selection: Selection,
    /// Which media are lights.
    pub media: MediumLights,
    /// What of skies is sampled.
    pub skies: Skies,
    /// Whether each of a few lights is sampled at a path's first surface.
    pub each: bool,
}

impl Default for LightRules {
    fn default() -> Self {
        Self {
            selection: Selection::default(),
            media: MediumLights::default(),
            skies: Skies::default(),
            each: true,
        }
    }
}

/// A light that was chosen and the probability of the choice.
#[derive(Clone, Copy, Debug)]
pub struct Selected {
    /// The light.
    pub id: LightId,
    /// Probability.
    pub pmf: f32,
}

/// The lights and their distributions.
#[derive(Clone, Debug, Default)]
pub struct LightSet {
    lights: Vec<Light>,
    infinite: Vec<LightId>,
    volumes: Vec<(MediumId, LightId)>,
    has_points: bool,
    all: Option<Choice>,
    /// The same where skies of one radiance are left to chance, if there are any: for points of media ...
    within: Option<Option<Choice>>,
    /// ... and for surfaces that are not a path's first.
    on_surfaces: bool,
    local: Option<Choice>,
    /// The tree over the local ones, the choice among the others, and what decides between the two.
    spatial: Option<Spatial>,
}

#[derive(Clone, Debug)]
struct Spatial {
    tree: LightTree,
    is_local: Vec<bool>,
    /// For surfaces and for points of media.
    far: [Far; 2],
}

/// Lights that are not in the tree.
#[derive(Clone, Debug)]
struct Far {
    choice: Option<Choice>,
    /// What they send, as the tree's importance counts.
    sent: f32,
}

#[derive(Clone, Debug)]
struct Choice {
    alias: Alias,
    ids: Vec<LightId>,
    /// Probability of every light of the scene, 0 for those left out.
    pmf: Vec<f32>,
}

impl Choice {
    fn new(powers: &[f64], keep: impl Fn(usize) -> bool) -> Option<Self> {
        let ids: Vec<usize> = (0..powers.len()).filter(|&i| keep(i) && powers[i] > 0.0).collect();
        let total: f64 = ids.iter().map(|&i| powers[i]).sum();
        let floor = UNIFORM_SHARE * total / ids.len().max(1) as f64;
        let weights: Vec<f64> = ids.iter().map(|&i| (1.0 - UNIFORM_SHARE) * powers[i] + floor).collect();
        let alias = Alias::new(&weights).ok()?;
        let mut pmf = vec![0.0; powers.len()];
        for (slot, &i) in ids.iter().enumerate() {
            pmf[i] = alias.pmf(slot);
        }
        Some(Self { alias, ids: ids.into_iter().map(|i| LightId(i as u32)).collect(), pmf })
    }

    #[inline(always)]
    fn select(&self, u: f32) -> Selected {
        let slot = self.alias.sample(u);
        Selected { id: self.ids[slot], pmf: self.pmf[self.ids[slot].index()] }
    }
}

impl LightSet {
    /// `weigh` integrates an emission spectrum over wavelength.
    pub fn new(lights: Vec<Light>, scene_radius: f32, weigh: &dyn Fn(&Emission) -> f64) -> Self {
        let powers: Vec<f64> = lights.iter().map(|l| l.extent(scene_radius) * weigh(l.spectrum())).collect();
        let infinite = (0..lights.len()).filter(|&i| lights[i].is_sky()).map(|i| LightId(i as u32)).collect();
        let volume = |(i, l): (usize, &Light)| match l {
            Light::Volume(l) => Some((l.medium(), LightId(i as u32))),
            _ => None,
        };
        let volumes = lights.iter().enumerate().filter_map(volume).collect();
        let all = Choice::new(&powers, |_| true);
        let local = Choice::new(&powers, |i| lights[i].is_local());
        let has_points = lights.iter().any(|l| l.is_local() && l.is_delta());
        Self {
            lights,
            infinite,
            volumes,
            has_points,
            all,
            within: None,
            on_surfaces: false,
            local,
            spatial: None,
        }
    }

    /// The same lights, sampled by these rules; `weigh` as for [`Self::new`].
    pub fn choosing(
        mut self,
        LightRules { selection, skies, each, .. }: LightRules,
        accel: &Accel,
        scene_radius: f32,
        weigh: &dyn Fn(&Emission) -> f64,
    ) -> Self {
        let powers: Vec<f64> =
            self.lights.iter().map(|l| l.extent(scene_radius) * weigh(l.spectrum())).collect();
        if skies == Skies::Always {
            self.lights.iter_mut().for_each(Light::sample_all);
        }
        let within: Vec<bool> =
            self.lights.iter().map(|l| skies == Skies::Always || !l.is_even_sky()).collect();
        // at a path's first surface each light is sampled: later ones need not choose a sky that chance finds
        self.on_surfaces = each && within.contains(&false) && self.few().is_some();
        if selection == Selection::Tree {
            self.spatial = self.spatial(accel, scene_radius, (&powers, &within));
        }
        let mut weights = powers;
        if selection == Selection::Uniform {
            weights.iter_mut().for_each(|p| *p = f64::from(u8::from(*p > 0.0)));
            self.all = Choice::new(&weights, |_| true);
        }
        self.within = within.contains(&false).then(|| Choice::new(&weights, |i| within[i]));
        self
    }

    fn spatial(
        &self,
        accel: &Accel,
        scene_radius: f32,
        (powers, within): (&[f64], &[bool]),
    ) -> Option<Spatial> {
        let bounds = |(i, l): (usize, &Light)| Some((i as u32, LightBounds::of(l, accel, powers[i])?));
        let local: Vec<_> = self.lights.iter().enumerate().filter_map(bounds).collect();
        let is_local: Vec<bool> = self.lights.iter().map(Light::has_place).collect();
        let is_far = is_local.contains(&false);
        // media know where they send light, even few of them
        if local.is_empty() || (local.len() < FEW && self.volumes.is_empty() && !is_far) {
            return None;
        }
        // pi times the irradiance: of a sky pi^2 L, where its power is 4 pi L times the scene's disk; of a sun pi times its
        // power over that disk
        let radius2 = f64::from(scene_radius) * f64::from(scene_radius);
        // a point of a medium takes light from the whole sphere of a sky, a surface a quarter of that
        let far = |in_medium: bool| {
            let keep = |i: usize| !is_local[i] && (within[i] || !(in_medium || self.on_surfaces));
            let per = |l: &Light| match l {
                Light::Infinite(_) | Light::Image(_) if !in_medium => 4.0,
                _ => 1.0,
            };
            let sent: f64 =
                (0..powers.len()).filter(|&i| keep(i)).map(|i| powers[i] / per(&self.lights[i])).sum();
            let sent = if sent > 0.0 && radius2 > 0.0 { (sent / radius2) as f32 } else { 0.0 };
            Far { choice: Choice::new(powers, keep), sent }
        };
        let far = [far(false), far(true)];
        Some(Spatial { tree: LightTree::new(local, self.lights.len()), is_local, far })
    }

    /// Chooses a light for the point `p` with normal `n`, zero for none.
    #[inline(always)]
    pub fn select_at(&self, p: Vec3, n: Vec3, u: f32) -> Option<Selected> {
        match &self.spatial {
            None => self.for_point(n).map(|c| c.select(u)),
            Some(spatial) => spatial.select(p, n, u),
        }
    }

    /// Probability with which [`Self::select_at`] returns `id` for `p` and `n`.
    #[inline(always)]
    pub fn pmf_at(&self, p: Vec3, n: Vec3, id: LightId) -> f32 {
        match &self.spatial {
            None => self.for_point(n).map_or(0.0, |c| c.pmf[id.index()]),
            Some(spatial) => spatial.pmf(p, n, id),
        }
    }

    /// The choice for points with normal `n`, zero in a medium, where no tree chooses.
    #[inline(always)]
    fn for_point(&self, n: Vec3) -> Option<&Choice> {
        match &self.within {
            Some(within) if self.on_surfaces || n == Vec3::ZERO => within.as_ref(),
            _ => self.all.as_ref(),
        }
    }

    /// The light `id`.
    #[inline(always)]
    pub fn get(&self, id: LightId) -> &Light {
        &self.lights[id.index()]
    }

    /// All lights, where they are few enough to sample each of them, and how often: twice an area that is alone. `None` where
    /// they are many, or some are media or have no power to be chosen by, or one sample tells all; a sky alone is met by chance
    /// as well.
    #[inline(always)]
    pub fn few(&self) -> Option<(&[LightId], u32)> {
        let ids = &self.all.as_ref()?.ids;
        let every = ids.len() == self.lights.len();
        if !every || !self.volumes.is_empty() || ids.len() > FEW_TO_SAMPLE {
            return None;
        }
        match &ids[..] {
            [] => None,
            [one] => matches!(self.get(*one), Light::Area(_)).then_some((ids, 2)),
            _ => Some((ids, 1)),
        }
    }

    /// All lights in order.
    pub fn iter(&self) -> impl Iterator<Item = &Light> {
        self.lights.iter()
    }

    /// Number of lights.
    pub fn len(&self) -> usize {
        self.lights.len()
    }

    /// True when nothing emits.
    pub fn is_empty(&self) -> bool {
        self.lights.is_empty()
    }

    /// The light that medium `id` is, if it is one.
    #[inline(always)]
    pub fn of_medium(&self, id: MediumId) -> Option<(LightId, &VolumeLight)> {
        let (_, light) = self.volumes.iter().find(|(medium, _)| *medium == id)?;
        match self.get(*light) {
            Light::Volume(volume) => Some((*light, volume)),
            _ => None,
        }
    }

    /// Lights that rays which leave the scene meet.
    pub fn infinite(&self) -> &[LightId] {
        &self.infinite
    }

    /// Chooses among all lights.
    #[inline(always)]
    pub fn select(&self, u: f32) -> Option<Selected> {
        self.all.as_ref().map(|c| c.select(u))
    }

    /// Probability with which [`Self::select`] returns `id`.
    #[inline(always)]
    pub fn pmf(&self, id: LightId) -> f32 {
        self.all.as_ref().map_or(0.0, |c| c.pmf[id.index()])
    }

    /// True when some light has finite extent.
    #[inline(always)]
    pub fn has_local(&self) -> bool {
        self.local.is_some()
    }

    /// True when some light is a point, so that nothing bounds what it sends to points near it.
    #[inline(always)]
    pub fn has_points(&self) -> bool {
        self.has_points
    }

    /// Chooses among lights of finite extent.
    #[inline(always)]
    pub fn select_local(&self, u: f32) -> Option<Selected> {
        self.local.as_ref().map(|c| c.select(u))
    }

    /// Probability with which [`Self::select_local`] returns `id`.
    #[inline(always)]
    pub fn pmf_local(&self, id: LightId) -> f32 {
        self.local.as_ref().map_or(0.0, |c| c.pmf[id.index()])
    }
}

impl Spatial {
    /// The lights at infinity for points with normal `n`, zero in a medium.
    #[inline(always)]
    fn far(&self, n: Vec3) -> &Far {
        &self.far[usize::from(n == Vec3::ZERO)]
    }

    /// Share of the lights at infinity at `p` with normal `n`: all of it where no other sends anything.
    #[inline(always)]
    fn far_share(&self, p: Vec3, n: Vec3) -> f32 {
        let far = self.far(n);
        if far.choice.is_none() {
            return 0.0;
        }
        let near = self.tree.importance(p, n);
        if near <= 0.0 {
            return 1.0;
        }
        (far.sent / (near + far.sent)).clamp(LEAST, 1.0 - LEAST)
    }

    #[inline(never)]
    fn select(&self, p: Vec3, n: Vec3, u: f32) -> Option<Selected> {
        let far_share = self.far_share(p, n);
        if u < far_share {
            let far = self.far(n).choice.as_ref()?.select(u / far_share);
            return Some(Selected { pmf: far.pmf * far_share, ..far });
        }
        let rest = 1.0 - far_share;
        let u = ((u - far_share) / rest).clamp(0.0, 1.0 - f32::EPSILON);
        let (light, pmf) = self.tree.select(p, n, u)?;
        Some(Selected { id: LightId(light), pmf: pmf * rest })
    }

    #[inline(never)]
    fn pmf(&self, p: Vec3, n: Vec3, id: LightId) -> f32 {
        if self.is_local[id.index()] {
            return self.tree.pmf(p, n, id.0) * (1.0 - self.far_share(p, n));
        }
        self.far(n).choice.as_ref().map_or(0.0, |far| far.pmf[id.index()] * self.far_share(p, n))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::{AreaLight, DistantLight, PointLight, SpotLight, UniformInfiniteLight};
    use tyndall_base::{rng::Pcg32, vec::vec3};
    use tyndall_geometry::{BuildOptions, Shape, ShapeGroup, TriangleMesh};
    use tyndall_spectral::Curve;

    /// Fifty points, spots and triangles all over a cube, and a sun.
    fn scene() -> (Accel, LightSet) {
        let mut rng = Pcg32::new(5, 5);
        let mut at = || vec3(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 10.0;
        let mut corners = Vec::new();
        for _ in 0..20 {
            let p = at();
            corners.extend([p, p + vec3(0.3, 0.0, 0.1), p + vec3(0.0, 0.2, 0.3)]);
        }
        let indices = (0..20u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = TriangleMesh::new(indices, corners).expect("valid");
        let group = ShapeGroup::from(Shape::Triangles(mesh));
        let accel = Accel::build(vec![group], &[], Vec::new(), &BuildOptions::default()).expect("valid");
        let emission = || Curve::ONE.into();
        let mut lights: Vec<Light> = (0..20)
            .map(|prim| {
                let area = accel.group(0).area(prim);
                let two_sided = prim % 3 == 0;
                Light::Area(AreaLight { shape: 0, prim, area, emission: emission(), two_sided, extra: None })
            })
            .collect();
        for i in 0..30 {
            let p = at();
            lights.push(if i % 2 == 0 {
                Light::Point(PointLight { p, intensity: emission() })
            } else {
                let axis = at() - p;
                Light::Spot(SpotLight::new(p, axis, emission(), 40.0, 10.0).expect("valid"))
            });
        }
        lights.push(Light::Distant(DistantLight { towards: vec3(0.0, 0.0, 1.0), emission: emission() }));
        let set = LightSet::new(lights, 10.0, &|_| 1.0);
        let set = set.choosing(LightRules::default(), &accel, 10.0, &|_| 1.0);
        (accel, set)
    }

    #[test]
    fn probabilities_add_up_to_what_is_drawn() {
        let (_, set) = scene();
        let mut rng = Pcg32::new(9, 9);
        for k in 0..20 {
            let p = vec3(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 12.0 - Vec3::splat(1.0);
            let n = if k % 2 == 0 { Vec3::ZERO } else { vec3(0.6, 0.0, 0.8) };
            let pmf: Vec<f64> =
                (0..set.len()).map(|i| f64::from(set.pmf_at(p, n, LightId(i as u32)))).collect();
            let total: f64 = pmf.iter().sum();
            assert!(total < 1.0 + 1e-4, "{total}");
            let draws = 20_000;
            let mut counts = vec![0.0; set.len()];
            for _ in 0..draws {
                if let Some(s) = set.select_at(p, n, rng.next_f32()) {
                    counts[s.id.index()] += 1.0;
                    assert!((f64::from(s.pmf) / pmf[s.id.index()] - 1.0).abs() < 1e-3);
                }
            }
            for (count, pmf) in counts.iter().zip(&pmf) {
                let sigma = (f64::from(draws) * pmf * (1.0 - pmf).max(0.0)).sqrt();
                assert!((count - pmf * f64::from(draws)).abs() < 5.0 * sigma + 3.0, "{count} {pmf}");
            }
        }
    }

    /// Whatever can send light to a point has a probability there.
    #[test]
    fn no_light_is_lost() {
        let (accel, set) = scene();
        let mut rng = Pcg32::new(2, 9);
        let w = tyndall_spectral::Wavelengths::<1>::continuum([550.0], [1.0]);
        for _ in 0..300 {
            let p = vec3(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 10.0;
            for (i, light) in set.iter().enumerate() {
                if light.sample_li(&accel, p, rng.next_2d(), &w).is_some() {
                    assert!(set.pmf_at(p, Vec3::ZERO, LightId(i as u32)) > 0.0, "light {i} from {p:?}");
                }
            }
        }
    }

    /// The second moment of an estimate of all local light, `sum c^2 / p`, is less by the tree than by power at most
    /// points.
    #[test]
    fn the_tree_has_less_variance_than_power() {
        let (accel, set) = scene();
        let mut rng = Pcg32::new(4, 2);
        let w = tyndall_spectral::Wavelengths::<1>::continuum([550.0], [1.0]);
        let mut better = 0;
        for _ in 0..200 {
            let p = vec3(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 10.0;
            let far = set.spatial.as_ref().map_or(0.0, |s| s.far_share(p, Vec3::ZERO));
            let (mut by_tree, mut by_power) = (0.0, 0.0);
            for (i, light) in set.iter().enumerate().filter(|(_, l)| l.is_local()) {
                let id = LightId(i as u32);
                if let Some(s) = light.sample_li(&accel, p, [0.5, 0.5], &w) {
                    let c = s.l[0] / s.pdf;
                    by_tree += c * c / (set.pmf_at(p, Vec3::ZERO, id) / (1.0 - far));
                    by_power += c * c / set.pmf_local(id);
                }
            }
            better += usize::from(by_tree < by_power);
        }
        assert!(better > 150, "{better} of 200");
    }

    #[test]
    fn each_light_is_sampled_where_few_have_power() {
        let few = |powers: &[f32]| {
            let light = |&power: &f32| {
                let emission = Curve::Constant(power).into();
                Light::Distant(DistantLight { towards: vec3(0.0, 0.0, 1.0), emission })
            };
            let weigh = |e: &Emission| f64::from(e.continuum().eval(550.0));
            let set = LightSet::new(powers.iter().map(light).collect(), 1.0, &weigh);
            set.few().map(|(ids, times)| (ids.len(), times))
        };
        assert_eq!(few(&[1.0, 2.0]), Some((2, 1)));
        assert_eq!(few(&[1.0; FEW_TO_SAMPLE + 1]), None);
        // one sample tells all of a sun that is alone
        assert_eq!(few(&[1.0]), None);
        // a light that is never chosen is met by chance alone
        assert_eq!(few(&[1.0, 2.0, 0.0]), None);
    }

    /// A lamp over a plain under a sky: the nearer the lamp the more it is chosen, far from it the sky; points of a medium
    /// are lit by all of the sky.
    #[test]
    fn sky_and_lamp_share_by_what_they_send() {
        let corners = [vec3(-0.5, 2.0, -0.5), vec3(0.5, 2.0, -0.5), vec3(0.0, 2.0, 0.5)];
        let mesh = TriangleMesh::new(vec![[0, 1, 2]], corners.to_vec()).expect("valid");
        let group = ShapeGroup::from(Shape::Triangles(mesh));
        let accel = Accel::build(vec![group], &[], Vec::new(), &BuildOptions::default()).expect("valid");
        let (emission, area) = (Curve::Constant(10.0).into(), accel.group(0).area(0));
        let lamp = AreaLight { shape: 0, prim: 0, area, emission, two_sided: false, extra: None };
        let sky = UniformInfiniteLight { emission: Curve::ONE.into() };
        let w = tyndall_spectral::Wavelengths::<1>::continuum([550.0], [1.0]);
        let weigh = |e: &Emission| f64::from(e.sample(&w).hero());
        let lights = vec![Light::Area(lamp), Light::Infinite(sky)];
        let rules = LightRules { skies: Skies::Always, ..LightRules::default() };
        let set = LightSet::new(lights, 50.0, &weigh).choosing(rules, &accel, 50.0, &weigh);
        let up = vec3(0.0, 1.0, 0.0);
        let lamp_at = |p, n| set.pmf_at(p, n, LightId(0));
        // irradiance of the lamp at 1 m: area 0.5 m^2, L = 10; of the sky pi
        let below = lamp_at(vec3(0.0, 1.0, 0.0), up);
        assert!((below - 5.0 / (5.0 + std::f32::consts::PI)).abs() < 0.05, "{below}");
        assert!(lamp_at(vec3(0.0, 1.9, 0.0), up) > 1.1 * below, "under the lamp");
        assert!((lamp_at(vec3(30.0, 0.0, 0.0), up) - LEAST).abs() < 1e-6, "far away");
        assert!(lamp_at(vec3(0.0, 1.0, 0.0), Vec3::ZERO) < below, "in a medium");
        for p in [vec3(0.0, 1.0, 0.0), vec3(30.0, 0.0, 0.0)] {
            assert!((lamp_at(p, up) + set.pmf_at(p, up, LightId(1)) - 1.0).abs() < 1e-6);
        }
    }
}
