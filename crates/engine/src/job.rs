//! What is to be computed.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tyndall_film::{ErrorMode, FilmSpec, Guide};

use crate::EngineError;
use crate::schedule;

/// Which errors a target speaks of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// Luminance Y.
    Luminance,
    /// Every channel that has errors.
    Channels,
}

/// `--until rel=x`: 95 % of the pixels have a standard error of at most `rel` times max(value, a hundredth of the median).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// Relative standard error.
    pub rel: f64,
    /// Of what.
    pub quantity: Quantity,
    /// Only these pixels count, all of them; empty for 95 % of all pixels.
    pub probes: Vec<(u32, u32)>,
    /// Samples per pixel of the pilot stage, from which the counts of the second stage are fixed.
    pub pilot: u32,
}

impl Target {
    /// A target on luminance over the whole image with the usual pilot of 64 samples per pixel.
    pub fn luminance(rel: f64) -> Self {
        Self { rel, quantity: Quantity::Luminance, probes: Vec::new(), pilot: 64 }
    }
}

/// Part `index` (from 1) of `count` parts of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Which part, from 1.
    pub index: u32,
    /// Of how many.
    pub count: u32,
}

/// A job: everything that the result depends on, and how long to work at it.
#[derive(Clone, Debug)]
pub struct Job {
    /// The film: window, channels, seed, error mode.
    pub film: Arc<FilmSpec>,
    /// Hash of the scene with all that it refers to.
    pub scene_hash: String,
    /// Whatever else the samples depend on, as (name, value): integrator, spectral strategy, depth ... in the user's words.
    pub settings: Vec<(String, String)>,
    /// Samples per pixel; the ceiling when there is a target.
    pub spp: u32,
    /// Stop when the errors are small enough.
    pub target: Option<Target>,
    /// Stop at the end of the last round that is expected to fit. No part of the job's identity.
    pub time: Option<Duration>,
    /// Render a part only. No part of the job's identity.
    pub shard: Option<Shard>,
    /// A guide learned elsewhere.
    pub guide: Guide,
}

impl Job {
    /// A job of `spp` samples per pixel.
    pub fn new(film: Arc<FilmSpec>, spp: u32) -> Self {
        Self {
            film,
            scene_hash: String::new(),
            settings: Vec::new(),
            spp,
            target: None,
            time: None,
            shard: None,
            guide: Guide::default(),
        }
    }

    /// Checks the job, refusing with the reason what cannot be combined.
    pub fn validate(&self) -> Result<(), EngineError> {
        self.film.validate()?;
        let refuse = |what: String, hint| Err(EngineError::Job { what, hint });
        if self.spp == 0 || self.spp > schedule::MAX_SPP {
            let what = format!("expected 1 to {} samples per pixel, got {}", schedule::MAX_SPP, self.spp);
            return refuse(what, "give --spp a number in that range");
        }
        if let Some(c) = self.guide.counts.as_ref().filter(|c| c.bounds() != self.film.bounds) {
            let what =
                format!("the guide is for the window {:?}, the job has {:?}", c.bounds(), self.film.bounds);
            return refuse(what, "use the guide with the resolution and crop it was learned at");
        }
        self.validate_target()?;
        self.validate_shard()
    }

    fn validate_target(&self) -> Result<(), EngineError> {
        let Some(target) = &self.target else { return Ok(()) };
        let refuse = |what: String, hint| Err(EngineError::Job { what, hint });
        if !(target.rel > 0.0 && target.rel < 10.0) {
            return refuse(
                format!("expected a target above 0 and below 10, got rel={}", target.rel),
                "rel=1% is usual",
            );
        }
        let ErrorMode::Replicated { replicates } = self.film.mode else {
            return refuse(
                "a target needs replicated errors".into(),
                "conservative errors are upper estimates",
            );
        };
        let least = 2 * replicates;
        if target.pilot < least || target.pilot % replicates != 0 || target.pilot > schedule::MAX_SPP / 2 {
            let what = format!("a pilot of {} samples for {replicates} replicates", target.pilot);
            return refuse(
                what,
                "the pilot takes a multiple of the replicates, at least two samples for each",
            );
        }
        if self.spp < target.pilot + least {
            let what = format!("{} samples per pixel leave none after a pilot of {}", self.spp, target.pilot);
            return refuse(what, "raise --spp, which is the ceiling");
        }
        if let Some((x, y)) = target.probes.iter().find(|(x, y)| !self.film.bounds.contains(*x, *y)) {
            return refuse(format!("the probe pixel ({x}, {y}) is outside the image"), "pixels count from 0");
        }
        if self.guide.counts.is_some() {
            return refuse(
                "a target together with a guide of sample counts".into(),
                "the guide fixes the counts already",
            );
        }
        Ok(())
    }

    fn validate_shard(&self) -> Result<(), EngineError> {
        let Some(shard) = self.shard else { return Ok(()) };
        let refuse = |what: String, hint| Err(EngineError::Job { what, hint });
        if shard.count == 0 || shard.index == 0 || shard.index > shard.count {
            return refuse(format!("shard {}/{}", shard.index, shard.count), "shards are 1/N to N/N");
        }
        if self.target.is_some() {
            let hint = "learn a guide first and give it to every shard, or render without shards";
            return refuse("shards with a target, but without a guide".into(), hint);
        }
        if self.time.is_some() {
            let hint = "shards of one job must agree on their samples: give --spp instead";
            return refuse("shards with a time limit".into(), hint);
        }
        if self.samples().is_empty() {
            let what =
                format!("shard {}/{} of {} samples per pixel holds none", shard.index, shard.count, self.spp);
            return refuse(what, "use no more shards than samples per pixel");
        }
        Ok(())
    }

    /// The sample indices that this job (or shard) renders in its only stage.
    pub fn samples(&self) -> Range<u32> {
        let all = self.all_samples();
        match self.shard {
            None => all,
            Some(shard) => schedule::split(&self.guide, all, shard),
        }
    }

    /// The sample indices of the whole job.
    pub fn all_samples(&self) -> Range<u32> {
        match &self.guide.counts {
            None => 0..self.spp,
            Some(c) => c.span(&self.film.bounds),
        }
    }

    /// Mean samples per pixel of this job (or shard); `None` with a target, which decides that later.
    pub fn mean_spp(&self) -> Option<f64> {
        let window = &self.film.bounds;
        let samples = || schedule::cost(window, &self.samples(), &self.guide) as f64;
        self.target.is_none().then(|| samples() / window.area() as f64)
    }

    /// Everything that the bits depend on, as (name, value).
    pub fn identity(&self) -> Vec<(String, String)> {
        let film = &self.film;
        let mut id: Vec<(String, String)> = vec![
            ("version".into(), env!("CARGO_PKG_VERSION").into()),
            ("scene".into(), self.scene_hash.clone()),
            ("resolution".into(), format!("{} x {}", film.resolution[0], film.resolution[1])),
            ("window".into(), format!("{:?}", film.bounds)),
            ("seed".into(), film.seed.to_string()),
            ("samples per pixel".into(), self.spp.to_string()),
            ("error mode".into(), format!("{:?}", film.mode)),
            ("target".into(), self.target.as_ref().map_or("none".into(), |t| format!("{t:?}"))),
            ("guide".into(), guide_hash(&self.guide)),
            ("channels".into(), film.channel_names().join(" ")),
            ("film".into(), hash_of(film.as_ref())),
        ];
        id.extend(self.settings.iter().cloned());
        id
    }

    /// Hash of [`Job::identity`].
    pub fn hash(&self) -> String {
        identity_hash(&self.identity())
    }
}

/// Hash of an identity: that of [`Job::hash`].
pub fn identity_hash(identity: &[(String, String)]) -> String {
    hash_of(&identity)
}

/// Hash of a guide; `none` for an empty one.
pub fn guide_hash(guide: &Guide) -> String {
    if *guide == Guide::default() { "none".into() } else { short(blake3::hash(&guide.to_bytes())) }
}

fn hash_of(value: &impl Serialize) -> String {
    short(blake3::hash(&serde_json::to_vec(value).expect("plain data with finite numbers serialises")))
}

fn short(hash: blake3::Hash) -> String {
    hash.to_hex()[..32].to_string()
}

/// What differs between two identities, as `name: there and here`.
pub fn differences(there: &[(String, String)], here: &[(String, String)]) -> Vec<String> {
    let find =
        |id: &[(String, String)], name: &str| id.iter().find(|(n, _)| n == name).map(|(_, v)| v.clone());
    let names = here.iter().chain(there.iter().filter(|(n, _)| find(here, n).is_none())).map(|(n, _)| n);
    let mut out = Vec::new();
    for name in names {
        let (a, b) = (find(there, name), find(here, name));
        if a != b {
            let show = |v: Option<String>| v.map_or("nothing".into(), |v| format!("`{v}`"));
            out.push(format!("{name}: {} there, {} here", show(a), show(b)));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job() -> Job {
        Job::new(Arc::new(FilmSpec::xyz([8, 8], ErrorMode::REPLICATED)), 256)
    }

    #[test]
    fn every_field_that_matters_is_in_the_hash() {
        let base = job().hash();
        let film = |edit: fn(&mut FilmSpec)| {
            let mut j = job();
            edit(Arc::make_mut(&mut j.film));
            j.hash()
        };
        let mut hashes = vec![
            film(|f| f.seed = 1),
            film(|f| f.mode = ErrorMode::Conservative),
            film(|f| f.clamp = Some(3.0)),
            film(|f| f.square = 4),
            film(|f| f.bounds.x1 = 7),
            Job { spp: 255, ..job() }.hash(),
            Job { scene_hash: "x".into(), ..job() }.hash(),
            Job { settings: vec![("integrator".into(), "analog".into())], ..job() }.hash(),
            Job { target: Some(Target::luminance(0.01)), ..job() }.hash(),
        ];
        assert_eq!(Job { time: Some(Duration::from_secs(1)), ..job() }.hash(), base);
        assert_eq!(Job { shard: Some(Shard { index: 1, count: 2 }), ..job() }.hash(), base);
        hashes.push(base);
        hashes.sort();
        hashes.dedup();
        assert_eq!(hashes.len(), 10);
    }

    #[test]
    fn differences_name_both_sides() {
        let a = vec![("seed".into(), "1".into()), ("old".into(), "x".into())];
        let b = vec![("seed".into(), "2".into()), ("new".into(), "y".into())];
        let text = differences(&a, &b);
        assert_eq!(text.len(), 3);
        assert_eq!(text[0], "seed: `1` there, `2` here");
        assert_eq!(text[1], "new: nothing there, `y` here");
        assert!(differences(&a, &a).is_empty());
    }

    #[test]
    fn what_cannot_be_combined_is_refused_with_the_reason() {
        let shard = Some(Shard { index: 1, count: 2 });
        let cases = [
            (Job { shard, target: Some(Target::luminance(0.01)), ..job() }, "without a guide"),
            (Job { shard, time: Some(Duration::from_secs(1)), ..job() }, "time limit"),
            (Job { shard: Some(Shard { index: 3, count: 2 }), ..job() }, "1/N to N/N"),
            (Job { shard: Some(Shard { index: 1, count: 999 }), ..job() }, "holds none"),
            (Job { spp: 0, ..job() }, "samples per pixel"),
            (Job { target: Some(Target::luminance(-1.0)), ..job() }, "rel=-1"),
            (Job { spp: 64, target: Some(Target::luminance(0.01)), ..job() }, "ceiling"),
            (
                Job { target: Some(Target { probes: vec![(8, 0)], ..Target::luminance(0.1) }), ..job() },
                "outside the image",
            ),
        ];
        for (job, reason) in cases {
            let text = job.validate().unwrap_err().to_string();
            assert!(text.contains(reason), "{text}");
        }
        assert!(Job { shard, ..job() }.validate().is_ok());
    }
}
