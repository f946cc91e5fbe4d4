//! All lights of a scene and the choice among them: in proportion to power, with a floor for the weak.

use super::Light;
use crate::ids::LightId;
use tyndall_base::distribution::Alias;
use tyndall_spectral::Emission;

/// Share of the choice that ignores power, so that a light whose power the weights misjudge is still found.
const UNIFORM_SHARE: f64 = 0.02;

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
    all: Option<Choice>,
    local: Option<Choice>,
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
        let infinite = (0..lights.len())
            .filter(|&i| matches!(lights[i], Light::Infinite(_) | Light::Image(_)))
            .map(|i| LightId(i as u32))
            .collect();
        let all = Choice::new(&powers, |_| true);
        let local = Choice::new(&powers, |i| lights[i].is_local());
        Self { lights, infinite, all, local }
    }

    /// The light `id`.
    #[inline(always)]
    pub fn get(&self, id: LightId) -> &Light {
        &self.lights[id.index()]
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
