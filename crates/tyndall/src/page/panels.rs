//! Several drawings in one.

/// SVG elements in rows of `columns`, as one SVG element.
pub fn side_by_side(drawings: &[String], columns: usize) -> String {
    let sizes: Vec<[f64; 2]> = drawings.iter().map(|d| size(d)).collect();
    let width = sizes.iter().map(|s| s[0]).fold(0.0, f64::max);
    let (mut body, mut top, mut all) = (String::new(), 0.0, 0.0f64);
    for (row, sizes) in drawings.chunks(columns.max(1)).zip(sizes.chunks(columns.max(1))) {
        for (i, drawing) in row.iter().enumerate() {
            let place = format!("<svg x=\"{}\" y=\"{top}\"", i as f64 * width);
            body.push_str(&drawing.replacen("<svg", &place, 1));
            all = all.max((i + 1) as f64 * width);
        }
        top += sizes.iter().map(|s| s[1]).fold(0.0, f64::max);
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{all}\" height=\"{top}\" viewBox=\"0 0 {all} {top}\">\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>{body}</svg>"
    )
}

/// Width and height as the element's first attributes of these names say.
fn size(svg: &str) -> [f64; 2] {
    let attribute = |name: &str| {
        let rest = svg.split_once(&format!(" {name}=\""))?.1;
        rest.split('"').next()?.parse().ok()
    };
    ["width", "height"].map(|name| attribute(name).unwrap_or(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_size() {
        let one = |w: u32| format!("<svg xmlns=\"x\" width=\"{w}\" height=\"50\"><g/></svg>");
        let all = side_by_side(&[one(100), one(80), one(60)], 2);
        assert!(all.contains("width=\"200\" height=\"100\""), "{all}");
        assert!(all.contains("<svg x=\"100\" y=\"0\"") && all.contains("<svg x=\"0\" y=\"50\""), "{all}");
        assert_eq!(all.matches("<svg").count(), 4);
    }
}
