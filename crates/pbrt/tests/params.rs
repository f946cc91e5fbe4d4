//! Typed getters, and track of what was consumed.

#![allow(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use std::sync::Arc;

use tyndall_pbrt::{
    Diagnostics, DirectiveKind, FloatOrTexture, ParamSet, ParamState, ParamType, Scene, SpectrumOrTexture,
    SpectrumValue, parse_str,
};

fn scene(params: &str) -> Scene {
    parse_str("s.pbrt", &format!("WorldBegin\nShape \"thing\" {params}")).unwrap()
}

fn params(text: &str) -> ParamSet {
    let scene = scene(text);
    let DirectiveKind::Entity(entity) = &scene.directives[1].kind else { panic!("a shape") };
    entity.params.clone()
}

fn names(set: &ParamSet) -> Vec<&str> {
    set.unused().iter().map(|p| &*p.info.name).collect()
}

#[test]
fn values_and_defaults() {
    let p = params(
        r#""float a" 0.1 "integer b" [ 7 ] "bool c" false "string d" "x\\y" "texture e" "wood"
           "point2 f" [ 1 2 ] "vector3 g" [ 1 2 3 ] "normal3 h" [ 0 0 1 ] "rgb i" [ 4 5 6 ] "bool j" "true""#,
    );
    assert_eq!(p.float("a", 9.0).unwrap(), 0.1f32);
    assert_eq!(p.float64("a", 9.0).unwrap(), 0.1f64);
    assert_eq!(p.float("none", 9.0).unwrap(), 9.0);
    assert_eq!(p.integer("b", 0).unwrap(), 7);
    assert_eq!(p.number_opt("b").unwrap(), Some(7.0));
    assert!(!p.bool("c", true).unwrap());
    assert_eq!(p.string("d", "").unwrap(), "x\\y");
    assert_eq!(p.string("none", "default").unwrap(), "default");
    assert_eq!(p.texture_opt("e").unwrap().unwrap().as_str(), "wood");
    assert_eq!(p.point2_opt("f").unwrap(), Some([1.0, 2.0]));
    assert_eq!(p.vector3_opt("g").unwrap(), Some([1.0, 2.0, 3.0]));
    assert_eq!(p.normal_opt("h").unwrap(), Some([0.0, 0.0, 1.0]));
    assert_eq!(p.rgb_opt("i").unwrap(), Some([4.0, 5.0, 6.0]));
    assert_eq!(p.bool_opt("j").unwrap(), Some(true));
    assert!(p.unused().is_empty());
    assert_eq!(p.type_of("h"), Some(ParamType::Normal));
}

#[test]
fn lists() {
    let p = params(
        r#""float a" [ 1 2 3 ] "integer b" [ 1 -2 ] "bool c" [ true false ] "string d" [ "x" "y" ]
           "point3 e" [ 0 0 0 1 1 1 ] "point2 f" [ 1 2 3 4 ] "rgb g" [ 1 2 3 4 5 6 ]"#,
    );
    assert_eq!(*p.floats("a").unwrap().unwrap(), [1.0, 2.0, 3.0]);
    assert_eq!(*p.floats64("a").unwrap().unwrap(), [1.0, 2.0, 3.0]);
    assert_eq!(p.integers("b").unwrap().unwrap(), [1, -2]);
    assert_eq!(p.bools("c").unwrap().unwrap(), [true, false]);
    assert_eq!(p.strings("d").unwrap().unwrap().len(), 2);
    assert_eq!(p.point3s("e").unwrap().unwrap(), [[0.0; 3], [1.0; 3]]);
    assert_eq!(p.point2s("f").unwrap().unwrap(), [[1.0, 2.0], [3.0, 4.0]]);
    assert_eq!(p.rgbs("g").unwrap().unwrap()[1], [4.0, 5.0, 6.0]);
    assert_eq!(p.spectra("g").unwrap().unwrap().len(), 2);
    assert_eq!(p.floats("none").unwrap(), None);
}

/// 64 numbers keep double precision, 65 do not; both give the `f32` nearest to the text.
#[test]
fn short_lists_are_double() {
    for (n, exact) in [(64, true), (65, false)] {
        let p = params(&format!("\"float a\" [ {}]", "0.1 ".repeat(n)));
        let wide = p.floats64("a").unwrap().unwrap();
        assert_eq!(wide.len(), n);
        assert_eq!(wide.iter().all(|&x| x == 0.1), exact);
        assert!(p.floats("a").unwrap().unwrap().iter().all(|&x| x == 0.1));
    }
}

#[test]
fn what_nobody_asked_for_is_unused() {
    let p = params(r#""float radius" 1 "float Radius" 2 "integer n" 3 "string s" "x""#);
    p.float("radius", 0.0).unwrap();
    p.ignore("n", "our accelerator has no such knob");
    p.unsupported("s", "not there yet");
    p.ignore("absent", "nothing to mark");
    assert_eq!(names(&p), ["Radius"]);
    let out = Diagnostics::default();
    p.warn_unused(&["radius", "zmin", "zmax"], &out);
    let warning = &out.to_vec()[0];
    assert_eq!(
        warning.to_string(),
        "s.pbrt:2:32: warning: Shape \"thing\": unused parameter \"float Radius\""
    );
    assert_eq!(warning.hint.as_deref(), Some("did you mean `radius`?"));
    p.unsupported_rest("the shape as a whole is not supported");
    assert!(p.unused().is_empty());
}

#[test]
fn the_inventory_follows_every_parameter() {
    let scene = scene(r#""float a" 1 "float b" 2 "float c" 3 "float d" 4"#);
    let DirectiveKind::Entity(entity) = &scene.directives[1].kind else { panic!("a shape") };
    entity.params.float("a", 0.0).unwrap();
    entity.params.ignore("b", "why");
    entity.params.unsupported("c", "why not");
    let states: Vec<_> =
        scene.inventory.iter().map(|i| (i.name.to_string(), i.state().to_string())).collect();
    let expected = [("a", "consumed"), ("b", "ignored: why"), ("c", "unsupported: why not"), ("d", "unread")];
    assert_eq!(states, expected.map(|(a, b)| (a.to_string(), b.to_string())));
    let info = scene.inventory.iter().next().unwrap();
    assert_eq!(info.owner.to_string(), "Shape \"thing\"");
    assert_eq!(scene.sources.location(info.span).to_string(), "s.pbrt:2:15");
}

#[test]
fn the_last_of_a_name_counts() {
    let p = params(r#""float a" 1 "float a" 2"#);
    assert_eq!(p.float("a", 0.0).unwrap(), 2.0);
    assert!(p.unused().is_empty(), "the first is marked");
    let all = scene(r#""float a" 1 "float a" 2"#);
    let states: Vec<_> = all.inventory.iter().map(|i| i.state().to_string()).collect();
    assert_eq!(states, ["ignored: a later one of the same name counts", "unread"]);
    assert_eq!(
        all.diagnostics.to_vec()[0].to_string(),
        "s.pbrt:2:15: warning: parameter \"float a\" is given twice"
    );
}

#[test]
fn attributes_count_where_the_set_has_none() {
    let mut attributes = params(r#""rgb L" [ 1 2 3 ] "float radius" 5 "float unused" 1"#);
    attributes.set_color_space(&Arc::from("rec2020"));
    let mut p = params(r#""float radius" 1"#);
    p.inherit(&attributes);
    assert_eq!(p.float("radius", 0.0).unwrap(), 1.0);
    let space = Some(Arc::from("rec2020"));
    let rgb = SpectrumValue::Rgb { rgb: [1.0, 2.0, 3.0], color_space: space };
    assert_eq!(p.spectrum("L").unwrap(), Some(rgb));
    assert!(p.unused().is_empty(), "attributes may go unused");
    assert_eq!(attributes.find("L").unwrap().info.state(), ParamState::Consumed);
    assert_eq!(attributes.find("radius").unwrap().info.state(), ParamState::Unread);
}

#[test]
fn textures_stand_for_numbers_and_spectra() {
    let p = params(r#""texture a" "t" "float b" 2 "rgb c" [ 1 1 1 ] "texture d" "u" "string e" "x""#);
    assert!(
        matches!(p.float_or_texture("a").unwrap(), Some(FloatOrTexture::Texture(t)) if t.as_str() == "t")
    );
    assert_eq!(p.float_or_texture("b").unwrap(), Some(FloatOrTexture::Float(2.0)));
    assert!(matches!(p.spectrum_or_texture("c").unwrap(), Some(SpectrumOrTexture::Spectrum(_))));
    assert!(matches!(p.spectrum_or_texture("d").unwrap(), Some(SpectrumOrTexture::Texture(_))));
    assert_eq!(
        p.float_or_texture("e").unwrap_err().plain(),
        "s.pbrt:2:77: e: expected a parameter of type `float` or `texture`, got `string`\n\
         hint: write \"float e\""
    );
    assert!(p.spectrum_or_texture("e").unwrap_err().to_string().contains("`spectrum` or `rgb`"));
    assert_eq!(p.spectrum_or_texture("none").unwrap(), None);
}

#[test]
fn wrong_types_and_counts() {
    let p = params(r#""float a" [ 1 2 ] "string b" "x" "blackbody c" [ 5000 2 ] "float d" [ ]"#);
    assert_eq!(
        p.float("a", 0.0).unwrap_err().to_string(),
        "s.pbrt:2:25: a: must be one `float`, got 2 of them"
    );
    assert_eq!(
        p.float("b", 0.0).unwrap_err().plain(),
        "s.pbrt:2:33: b: expected a parameter of type `float`, got `string`\nhint: write \"float b\""
    );
    assert!(p.spectrum("c").unwrap_err().to_string().ends_with("must be one spectrum, got 2 of them"));
    assert_eq!(
        p.floats("d").unwrap_err().to_string(),
        "s.pbrt:2:83: d: must have a value, got an empty list"
    );
}

#[test]
fn readers_make_errors_at_values() {
    let p = params(
        "\n  \"float sigma_s\" [ -0.3 ]\n  \"spectrum n\" [ 400 1 300 2 ] \"string s\" [ \"a\" # ]\n \"b\" ]",
    );
    assert_eq!(
        p.error_at("sigma_s", "must be >= 0", "-0.3 1/m").hint("absorption cannot be negative").plain(),
        "s.pbrt:3:21: sigma_s: must be >= 0, got -0.3 1/m\nhint: absorption cannot be negative"
    );
    let at = |i| p.error_at_index("n", i, "must ascend", "300").location().unwrap().to_string();
    assert_eq!(at(2), "s.pbrt:4:24");
    assert_eq!(at(0), "s.pbrt:4:18");
    assert_eq!(at(99), "s.pbrt:4:16", "no such value: the list");
    assert_eq!(p.error_at_index("s", 1, "x", "y").location().unwrap().to_string(), "s.pbrt:5:2");
    assert_eq!(p.error_at("none", "x", "y").location().unwrap().to_string(), "s.pbrt:2:1");
    assert_eq!(
        p.missing("point3", "P").to_string(),
        "s.pbrt:2:1: Shape \"thing\": parameter \"point3 P\" is missing"
    );
}

#[test]
fn parameters_can_be_read_from_many_threads() {
    let p = params(r#""float a" 1 "float b" 2"#);
    std::thread::scope(|scope| {
        for name in ["a", "b"] {
            let p = &p;
            scope.spawn(move || p.float(name, 0.0).unwrap());
        }
    });
    assert!(p.unused().is_empty());
}

/// A hostile directive with very many parameters takes linear time.
#[test]
fn very_many_parameters() {
    let p = params(&"\"float a\" 1 ".repeat(200_000));
    assert_eq!(p.len(), 200_000);
    p.float("a", 0.0).unwrap();
    assert!(p.unused().is_empty());
}
