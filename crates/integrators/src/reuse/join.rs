//! Who shares what a path goes on from.
//!
//! In media that vary lengths are dear: through grids of densities they are known exactly (see
//! [`tyndall_transport::media`]), but not for each of many links. All weights need is that they add up to one, so that the
//! densities `q` they are made of may be those of coarse lengths, which take a few looks each. Then
//!
//! ```text
//! L_i = sum_k F(x_i, y_k) S(y_k) / mean_l( sum_m q_l(y_k | x_m) ) q_h(y_k | x_k) / p_h(y_k | x_k)
//! ```
//!
//! where path k was led by lane h with the density p of the exact length. `F` is that of the coarse length too, but for one
//! link of some points, drawn at random, which brings what the others lack: the exact one less the coarse one, by the
//! number it stands for.

use super::{
    company::Company,
    depart::{Member, Origins},
    end::{Link, Shared},
};
use crate::{
    pixel::PixelPass,
    settings::{Lengths, Settings},
};
use tyndall_base::Vec3;
use tyndall_geometry::Ray;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{Scene, media::Medium, scene::Obstacles};

/// Of so many points that are shared one has a link worked out exactly.
const MENDED: usize = 2;
/// Rays of one query.
const FAN: usize = 16;
/// Fills what no ray fills.
const NOWHERE: Ray = Ray { o: Vec3::ZERO, d: Vec3::ZERO, t_max: 0.0, time: 0.0 };

/// Settings that links are worked out with.
pub(super) struct Yardsticks {
    /// Some medium varies in space.
    pub varies: bool,
    exact: Settings,
    /// What weights are made of.
    weigh: Settings,
}

impl Yardsticks {
    /// For a scene, with weights of such lengths.
    pub fn of(scene: &Scene, settings: &Settings, weigh: Lengths) -> Self {
        let varies = varies(scene);
        let with = |lengths| Settings { lengths, ..settings.clone() };
        Self { varies, exact: with(Lengths::Exact), weigh: with(weigh) }
    }
}

/// Whether some medium varies in space.
pub(super) fn varies(scene: &Scene) -> bool {
    scene.media.iter().any(|m| matches!(m, Medium::Heterogeneous(_)))
}

impl PixelPass {
    /// Who shares what path `k`, that of `member`, goes on from; `None` where it goes on alone.
    #[inline(always)]
    pub(super) fn company<'a, const N: usize>(
        &self,
        yardsticks: &Yardsticks,
        (origins, links): (&Origins<'_, N>, &'a mut Vec<(usize, Link<N>)>),
        k: usize,
        member: &mut Member<'_, N>,
        w: &Wavelengths<N>,
    ) -> Option<Company<'a, N>> {
        let Member { walk, site, sampler, .. } = member;
        let (Some(at), Some(from)) = (&site, &origins[k]) else { return None };
        let varies = yardsticks.varies;
        let shared = Shared::new(walk, at)?;
        let mut company = Company::empty(links);
        let (mut mended, mut begun) = (usize::MAX, !varies);
        if varies {
            mended = (sampler.next_1d() * (MENDED * origins.len()) as f32) as usize;
        } else {
            let (link, own) = shared.own_link(walk, from)?;
            company.begin(k, link, own, 1.0);
        }
        for first in (0..origins.len()).step_by(FAN) {
            // one query for the rays of several members to the point
            let (mut aims, mut fan, mut n) = ([const { None }; FAN], [NOWHERE; FAN], 0);
            for i in 0..FAN {
                if (varies || first + i != k)
                    && let Some(from) = &origins[first + i]
                    && let Some(aim) = shared.aim(from, w)
                {
                    fan[n] = aim.ray;
                    n += 1;
                    aims[i] = Some(aim);
                }
            }
            let mut obstacles = [Obstacles::BLOCKED; FAN];
            self.scene.obstacles_fan(&fan[..n], &mut obstacles[..n]);
            let mut n = 0;
            for i in 0..FAN {
                let member = first + i;
                let (Some(aim), Some(from)) = (&aims[i], &origins[member]) else { continue };
                let Obstacles { blocked, boundaries } = obstacles[n];
                n += 1;
                if blocked {
                    continue;
                }
                let scene = (&*self.scene, &yardsticks.weigh);
                let Some(link) = shared.link(scene, from, aim, boundaries, w, sampler) else { continue };
                if varies && (member == k || member == mended) {
                    let scene = (&*self.scene, &yardsticks.exact);
                    let exact = shared.link_apart(scene, from, aim, boundaries, w, sampler);
                    if member == k {
                        begun = company.begin_by(k, exact?, link);
                        continue;
                    }
                    let exact = exact.map_or(Spectrum::ZERO, |exact| exact.through);
                    company.mend((exact - link.through) * (MENDED * origins.len()) as f32);
                }
                company.join(member, link);
            }
        }
        // rounding may hide a point from its own path
        begun.then_some(company)
    }
}
