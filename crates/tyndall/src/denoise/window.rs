//! Pixels around a pixel.

/// The values of a plane at most `radius` away from a pixel, which comes first; the window is cut at the edges.
pub(super) fn around(
    plane: &[f32],
    width: usize,
    [x, y]: [usize; 2],
    radius: usize,
) -> impl Iterator<Item = f32> {
    let height = plane.len() / width;
    let columns = x.saturating_sub(radius)..(x + radius + 1).min(width);
    let rows = y.saturating_sub(radius)..(y + radius + 1).min(height);
    let others = rows
        .flat_map(move |j| columns.clone().map(move |i| (i, j)))
        .filter(move |at| *at != (x, y))
        .map(move |(i, j)| plane[j * width + i]);
    std::iter::once(plane[y * width + x]).chain(others)
}

/// The median of the finite values: the lower one of two; zero without any.
pub(super) fn median(values: &mut Vec<f32>) -> f32 {
    values.retain(|v| v.is_finite());
    if values.is_empty() {
        return 0.0;
    }
    let middle = (values.len() - 1) / 2;
    *values.select_nth_unstable_by(middle, f32::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_cut_at_the_edges() {
        let plane: Vec<f32> = (0..12u8).map(f32::from).collect();
        let near = |x, y| around(&plane, 4, [x, y], 1).collect::<Vec<_>>();
        assert_eq!(near(0, 0), [0.0, 1.0, 4.0, 5.0]);
        assert_eq!(near(1, 1), [5.0, 0.0, 1.0, 2.0, 4.0, 6.0, 8.0, 9.0, 10.0]);
        assert_eq!(near(3, 2), [11.0, 6.0, 7.0, 10.0]);
    }

    #[test]
    fn medians_pass_over_what_is_not_finite() {
        assert_eq!(median(&mut vec![3.0, f32::NAN, 1.0, 2.0, f32::INFINITY]), 2.0);
        assert_eq!((median(&mut vec![4.0, 1.0]), median(&mut vec![f32::NAN])), (1.0, 0.0));
    }
}
