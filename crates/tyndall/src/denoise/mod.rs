//! Pictures without grain, for the eye: non-local means that know the standard error of every number.
//!
//! Weights compare patches in units of their noise (Rousselle, Knaus & Zwicker 2012, *Adaptive rendering with
//! non-local means filtering*), over three scales (Delbracio, Muse, Buades, Chauvier, Phelps & Morel 2014, *Boosting
//! Monte Carlo rendering by ray histogram fusion*). Where a number has no error it stays, to the bit.
//!
//! What comes out is biased in an unknown way and has no standard error: it is to be looked at, never to be measured.

mod kernel;
mod noisy;
mod outlier;
mod pool;
mod pyramid;
mod window;

#[cfg(test)]
mod tests;

use crate::Error;
use kernel::Filtered;
pub use noisy::{Channel, Noisy};
use rayon::prelude::*;

/// Scales beside the finest; each halves the picture.
const COARSER: usize = 2;

/// The picture without its noise: one plane a channel, in the order of the channels. Any number of threads gives the
/// same bits.
///
/// # Errors
/// When the threads cannot be started.
pub fn denoise(picture: &Noisy, threads: usize) -> Result<Vec<Vec<f32>>, Error> {
    // more threads than strips would idle
    let threads = threads.min(picture.height.div_ceil(kernel::ROWS)).max(1);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|e| {
        let hint = "give --threads a smaller number";
        Error::options(format!("cannot start {threads} threads: {e}"), Some(hint.into()))
    })?;
    Ok(pool.install(|| clean(picture)))
}

fn clean(picture: &Noisy) -> Vec<Vec<f32>> {
    let mut smooth = picture.clone();
    for channel in &mut smooth.channels {
        outlier::replace(channel, picture.width);
        channel.variance = pool::pool(channel, picture.width);
    }
    let mut planes = scales(&smooth, COARSER).planes;
    for (plane, given) in planes.iter_mut().zip(&picture.channels) {
        restore(plane, given);
    }
    planes
}

/// What is not finite is shown as such.
fn restore(plane: &mut [f32], given: &Channel) {
    plane.iter_mut().zip(&given.mean).filter(|(_, m)| !m.is_finite()).for_each(|(v, m)| *v = *m);
}

/// The finest scale keeps its detail and takes its slow changes from the coarser ones, where the noise is less.
fn scales(picture: &Noisy, coarser: usize) -> Filtered {
    let mut fine = kernel::filter(picture);
    if coarser == 0 || picture.width.min(picture.height) < 2 * kernel::REACH {
        return fine;
    }
    let coarse = scales(&picture.halved(), coarser - 1);
    let size = [picture.width, picture.height];
    let planes = fine.planes.par_iter_mut().zip(&coarse.planes);
    planes.for_each(|(fine, plane)| pyramid::correct(fine, plane, &coarse.total, size));
    fine
}
