//! Halving a picture and going back.

/// Columns and rows of the half.
pub(super) fn half_size(size: [usize; 2]) -> [usize; 2] {
    size.map(|n| n.div_ceil(2))
}

/// Sums over 2 x 2 pixels, divided by their number to the power `power`: 1 for means, 2 for variances of means.
pub(super) fn halve(plane: &[f32], size: [usize; 2], power: i32) -> Vec<f32> {
    let [width, height] = half_size(size);
    let mut out = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let columns = 2 * x..(2 * x + 2).min(size[0]);
            let rows = 2 * y..(2 * y + 2).min(size[1]);
            let count = (columns.len() * rows.len()) as f32;
            let row = |j: usize| plane[j * size[0]..][columns.clone()].iter().sum::<f32>();
            let sum: f32 = rows.map(row).sum();
            out.push(if power == 1 { sum / count } else { sum / (count * count) });
        }
    }
    out
}

/// Others like it that a coarse pixel needs before it may correct the fine ones: the rim of a lamp has none, and would spill.
const COMPANY: f32 = 2.0;

/// `fine + up(t (coarse - down(fine)))`: the means over 2 x 2 pixels become nearly those of the coarse picture, the detail
/// stays. `up` interpolates linearly between the middles of the coarse pixels; the trust t in [0, 1] grows with the sum of
/// weights `total` that is in a coarse pixel.
pub(super) fn correct(fine: &mut [f32], coarse: &[f32], total: &[f32], size: [usize; 2]) {
    let [width, height] = half_size(size);
    let trust = |total: f32| ((total - 1.0) / COMPANY).min(1.0);
    let means = halve(fine, size, 1);
    let missing: Vec<f32> =
        coarse.iter().zip(means).zip(total).map(|((c, f), t)| trust(*t) * (c - f)).collect();
    for y in 0..size[1] {
        let rows = neighbours(y, height);
        for x in 0..size[0] {
            let columns = neighbours(x, width);
            let row =
                |j: usize| 0.75 * missing[j * width + columns[0]] + 0.25 * missing[j * width + columns[1]];
            fine[y * size[0] + x] += 0.75 * row(rows[0]) + 0.25 * row(rows[1]);
        }
    }
}

/// The coarse pixel that holds a fine one, and the nearest other (itself at the edge).
fn neighbours(fine: usize, count: usize) -> [usize; 2] {
    let own = fine / 2;
    let other = if fine.is_multiple_of(2) { own.saturating_sub(1) } else { (own + 1).min(count - 1) };
    [own, other]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_means() {
        let plane = [1.0, 3.0, 5.0, 2.0, 6.0, 7.0];
        assert_eq!(halve(&plane, [3, 2], 1), [3.0, 6.0]);
        assert_eq!(halve(&plane, [3, 2], 2), [12.0 / 16.0, 12.0 / 4.0]);
    }

    #[test]
    fn a_ramp_is_kept_and_a_shift_taken_over() {
        let ramp: Vec<f32> = (0..64u8).map(|p| f32::from(p % 8)).collect();
        let mut fine = ramp.clone();
        let coarse: Vec<f32> = halve(&ramp, [8, 8], 1).iter().map(|v| v + 4.0).collect();
        correct(&mut fine, &coarse, &[3.0; 16], [8, 8]);
        assert!(fine.iter().zip(&ramp).all(|(f, r)| *f == r + 4.0), "{fine:?}");
        correct(&mut fine, &[9.0; 16], &[1.0; 16], [8, 8]);
        assert!(fine.iter().zip(&ramp).all(|(f, r)| *f == r + 4.0), "pixels without company correct nothing");
    }
}
