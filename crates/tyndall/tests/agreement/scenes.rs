//! Small chromatic scenes, 12 x 12 pixels: each is there for techniques that the others leave idle.

/// A scene and what may be asked of it.
pub struct SmallScene {
    pub name: &'static str,
    pub text: &'static str,
    /// Scatterings a path may have.
    pub max_depth: u32,
    /// Samples per pixel of an ordinary variant.
    pub spp: u32,
    /// Point, spot or distant lights, which analog paths never meet.
    pub delta_lights: bool,
    /// Spectral lines, which a fixed set of wavelengths misses.
    pub lines: bool,
}

const fn scene(name: &'static str, text: &'static str, max_depth: u32, spp: u32) -> SmallScene {
    SmallScene { name, text, max_depth, spp, delta_lights: false, lines: false }
}

/// Blue fog with forward scattering between coloured walls, a lamp in the fog, camera outside.
pub const FOG_BOX: SmallScene = scene(
    "fog box",
    r#"
    LookAt 0 0 3.9  0 0 0  0 1 0
    Camera "perspective" "float fov" 39
    Film "rgb" "string sensor" "cie1931" "integer xresolution" 12 "integer yresolution" 12
    WorldBegin
    MakeNamedMedium "fog" "string type" "homogeneous" "float g" 0.4
      "spectrum sigma_s" [360 1.0 500 0.9 600 0.35 830 0.1]
      "spectrum sigma_a" [360 0.02 550 0.03 650 0.5 830 0.7]
    Material "diffuse" "spectrum reflectance" [360 0.7 830 0.75]
    Shape "bilinearmesh" "point3 P" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]
    Shape "bilinearmesh" "point3 P" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1]
    Material "diffuse" "spectrum reflectance" [360 0.05 560 0.05 640 0.62 830 0.66]
    Shape "bilinearmesh" "point3 P" [-1 -1 -1  -1 1 -1  -1 -1 1  -1 1 1]
    AttributeBegin
      AreaLightSource "diffuse" "spectrum L" [360 15 560 15 830 8]
      Shape "bilinearmesh" "point3 P" [-0.5 0.95 -0.5  0.5 0.95 -0.5  -0.5 0.95 0.5  0.5 0.95 0.5]
    AttributeEnd
    MediumInterface "fog" ""
    Material "interface"
    Scale 0.98 0.98 0.98
    Shape "trianglemesh" "integer indices" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 7 6 3 6 2  0 4 7 0 7 3  1 2 6 1 6 5]
      "point3 P" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]
    "#,
    6,
    256,
);

/// A spotlight's beam across thin fog over a floor, camera in the fog. The light stands outside: next to a point of light
/// in a medium 1/d^2 has no variance, and a test of means no meaning.
pub const THIN_SPOT: SmallScene = SmallScene {
    delta_lights: true,
    ..scene(
        "thin fog with a spotlight",
        r#"
        MakeNamedMedium "mist" "string type" "homogeneous" "float g" 0.5
          "spectrum sigma_s" [360 0.12 550 0.08 830 0.03] "spectrum sigma_a" [360 0.002 600 0.005 830 0.04]
        MediumInterface "" "mist"
        LookAt 0 1 3.8  0 1 0  0 1 0
        Camera "perspective" "float fov" 45
        Film "rgb" "string sensor" "cie1931" "integer xresolution" 12 "integer yresolution" 12
        WorldBegin
        LightSource "spot" "spectrum I" [360 40 600 80 830 60] "point3 from" [-2.5 4 0] "point3 to" [1 0 -0.5]
          "float coneangle" 9 "float conedeltaangle" 4
        Material "diffuse" "spectrum reflectance" [360 0.2 600 0.6 830 0.3]
        Shape "bilinearmesh" "point3 P" [-9 -0.1 -9  9 -0.1 -9  -9 -0.1 9  9 -0.1 9]
        MediumInterface "mist" ""
        Material "interface"
        Translate 0 1.5 0
        Scale 4 1.5 4
        Shape "trianglemesh" "integer indices" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 7 6 3 6 2  0 4 7 0 7 3  1 2 6 1 6 5]
          "point3 P" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]
        "#,
        6,
        256,
    )
};

/// A point light with spectral lines in a bubble inside a dense dark ball, another outside.
pub const POINT_LINES: SmallScene = SmallScene {
    delta_lights: true,
    lines: true,
    ..scene(
        "point lights with lines",
        r#"
        LookAt 0 0.5 4  0 0 0  0 1 0
        Camera "perspective" "float fov" 40
        Film "rgb" "string sensor" "cie1931" "integer xresolution" 12 "integer yresolution" 12
        WorldBegin
        MakeNamedMedium "smoke" "string type" "homogeneous" "float g" -0.3
          "spectrum sigma_s" [360 0.6 550 0.8 830 1.4] "spectrum sigma_a" [360 0.9 550 0.7 830 0.3]
        LightSource "point" "spectrum I" [360 3 600 6 830 4] "float lines" [589.3 300 435.8 200] "point3 from" [0.2 0.1 0.3]
        LightSource "point" "spectrum I" [360 20 600 9 830 4] "point3 from" [-2 2 1]
        Material "diffuse" "spectrum reflectance" [360 0.2 600 0.6 830 0.3]
        Shape "bilinearmesh" "point3 P" [-9 -1.2 -9  9 -1.2 -9  -9 -1.2 9  9 -1.2 9]
        Material "interface"
        MediumInterface "smoke" ""
        Shape "sphere" "float radius" 1
        MediumInterface "" "smoke"
        Translate 0.2 0.1 0.3
        Shape "sphere" "float radius" 0.3
        "#,
        6,
        256,
    )
};

/// A bright, thick ball with an index-matched boundary under a uniform sky: paths without a limit of length.
pub const SKY_BALL: SmallScene = scene(
    "ball under a uniform sky, unlimited depth",
    r#"
    LookAt 0 0 4  0 0 0  0 1 0
    Camera "perspective" "float fov" 32
    Film "rgb" "string sensor" "cie1931" "integer xresolution" 12 "integer yresolution" 12
    WorldBegin
    MakeNamedMedium "milk" "string type" "homogeneous" "float g" 0.6
      "spectrum sigma_s" [360 6 550 4.5 830 2] "spectrum sigma_a" [360 0.3 550 0.05 830 0.4]
    LightSource "infinite" "spectrum L" [360 2 550 1 830 0.5]
    Material "diffuse" "spectrum reflectance" [360 0.5 600 0.2 830 0.7]
    Shape "disk" "float radius" 3 "float height" -1
    MediumInterface "milk" ""
    Material "interface"
    Shape "sphere" "float radius" 1
    "#,
    u32::MAX,
    192,
);

/// A dispersive glass ball in fog, camera in the fog, a lamp that is met through the glass.
pub const GLASS_IN_FOG: SmallScene = scene(
    "glass ball in fog",
    r#"
    MakeNamedMedium "fog" "string type" "homogeneous" "float g" 0.2
      "spectrum sigma_s" [360 0.3 600 0.2 830 0.06] "spectrum sigma_a" [360 0.01 550 0.02 830 0.2]
    MediumInterface "" "fog"
    LookAt 0 0 3.2  0 0 0  0 1 0
    Camera "perspective" "float fov" 40
    Film "rgb" "string sensor" "cie1931" "integer xresolution" 12 "integer yresolution" 12
    WorldBegin
    MediumInterface "fog" "fog"
    Material "diffuse" "spectrum reflectance" [360 0.7 500 0.5 830 0.75]
    Shape "bilinearmesh" "point3 P" [-3 -1 -3  3 -1 -3  -3 -1 3  3 -1 3]
    AttributeBegin
      AreaLightSource "diffuse" "spectrum L" [360 15 560 10 830 8] "bool twosided" true
      Shape "bilinearmesh" "point3 P" [-1 2 -1  1 2 -1  -1 2 1  1 2 1]
    AttributeEnd
    MediumInterface "" "fog"
    Material "dielectric" "spectrum eta" "glass-SF11"
    Shape "sphere" "float radius" 0.7
    "#,
    6,
    256,
);

/// A medium that glows and scatters its own light, lamp on one side.
pub const GLOWING: SmallScene = scene(
    "glowing medium",
    r#"
    LookAt 0 0.4 4  0 0 0  0 1 0
    Camera "perspective" "float fov" 38
    Film "rgb" "string sensor" "cie1931" "integer xresolution" 12 "integer yresolution" 12
    WorldBegin
    MakeNamedMedium "flame" "string type" "homogeneous" "float g" 0
      "spectrum sigma_s" [360 1.2 550 0.6 830 0.2] "spectrum sigma_a" [360 1.5 550 0.4 830 0.1]
      "spectrum Le" [360 0.3 600 1.5 830 4] "float Lescale" 2
    AttributeBegin
      AreaLightSource "diffuse" "spectrum L" [360 4 560 3 830 1]
      Translate -2.2 0.8 0.5
      Shape "sphere" "float radius" 0.5
    AttributeEnd
    Material "diffuse" "spectrum reflectance" [360 0.7 500 0.5 830 0.75]
    Shape "bilinearmesh" "point3 P" [-4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4]
    MediumInterface "flame" ""
    Material "interface"
    Shape "sphere" "float radius" 1
    "#,
    6,
    256,
);

/// Index-matched boundary around rough glass around a medium around an index-matched core; camera in the outer medium.
pub const NESTED: SmallScene = scene(
    "nested boundaries",
    r#"
    MakeNamedMedium "outer" "string type" "homogeneous" "float g" 0.3
      "spectrum sigma_s" [360 0.25 830 0.1] "spectrum sigma_a" [360 0.02 830 0.1]
    MakeNamedMedium "inner" "string type" "homogeneous" "float g" 0
      "spectrum sigma_s" [360 0.4 830 1.0] "spectrum sigma_a" [360 0.3 830 0.02]
    MakeNamedMedium "core" "string type" "homogeneous" "float g" 0.5
      "spectrum sigma_s" [360 3 830 1] "spectrum sigma_a" [360 0.1 550 1 830 0.1]
    MediumInterface "" "outer"
    LookAt 0 0 3.5  0 0 0  0 1 0
    Camera "perspective" "float fov" 38
    Film "rgb" "string sensor" "cie1931" "integer xresolution" 12 "integer yresolution" 12
    WorldBegin
    LightSource "infinite" "spectrum L" [360 0.5 830 0.8]
    AttributeBegin
      AreaLightSource "diffuse" "spectrum L" [360 9 560 6 830 5]
      Translate 2 2 2
      Shape "sphere" "float radius" 0.6
    AttributeEnd
    MediumInterface "outer" ""
    Material "interface"
    Shape "sphere" "float radius" 5
    MediumInterface "inner" "outer"
    Material "dielectric" "float eta" 1.33 "float roughness" 0.3
    Shape "sphere" "float radius" 1
    MediumInterface "core" "inner"
    Material "interface"
    Shape "sphere" "float radius" 0.5
    "#,
    6,
    256,
);

/// Brushed and polished metal, rough dispersive glass and a translucent sheet between coloured walls, with a mist in the room.
pub const GLOSSY: SmallScene = scene(
    "metal and rough glass",
    r#"
    MakeNamedMedium "mist" "string type" "homogeneous" "float g" 0.6
      "spectrum sigma_s" [360 0.1 550 0.06 830 0.02] "spectrum sigma_a" [360 0.01 830 0.03]
    MediumInterface "" "mist"
    LookAt 0 0 0.98  0 -0.2 0  0 1 0
    Camera "perspective" "float fov" 75
    Film "rgb" "string sensor" "cie1931" "integer xresolution" 12 "integer yresolution" 12
    WorldBegin
    MediumInterface "mist" "mist"
    Material "diffuse" "spectrum reflectance" [360 0.7 830 0.75]
    Shape "bilinearmesh" "point3 P" [-1 1 -1  1 1 -1  -1 1 1  1 1 1]
    Shape "bilinearmesh" "point3 P" [-1 -1 1  1 -1 1  -1 1 1  1 1 1]
    Shape "bilinearmesh" "point3 P" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1]
    Material "diffuse" "spectrum reflectance" [360 0.05 560 0.05 640 0.62 830 0.66]
    Shape "bilinearmesh" "point3 P" [-1 -1 -1  -1 1 -1  -1 -1 1  -1 1 1]
    Material "diffuse" "spectrum reflectance" [360 0.1 460 0.5 560 0.2 830 0.1]
    Shape "bilinearmesh" "point3 P" [1 -1 -1  1 1 -1  1 -1 1  1 1 1]
    Material "conductor" "bool remaproughness" false "float uroughness" 0.15 "float vroughness" 0.4
      "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k"
    Shape "bilinearmesh" "point3 P" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]
    AttributeBegin
      Material "conductor" "bool remaproughness" false "float roughness" 0.12
      Translate -0.45 -0.55 -0.3
      Shape "sphere" "float radius" 0.4
    AttributeEnd
    AttributeBegin
      Material "dielectric" "bool remaproughness" false "float roughness" 0.25 "spectrum eta" "glass-SF11"
      MediumInterface "" "mist"
      Translate 0.5 -0.6 0
      Shape "sphere" "float radius" 0.35
    AttributeEnd
    Material "diffusetransmission" "spectrum reflectance" [360 0.2 830 0.4] "spectrum transmittance" [360 0.5 830 0.2]
    Shape "bilinearmesh" "point3 P" [-0.2 -0.3 -0.7  0.4 -0.3 -0.6  -0.2 0.4 -0.7  0.4 0.4 -0.6]
    AttributeBegin
      AreaLightSource "diffuse" "spectrum L" [360 9 560 8 830 5]
      Shape "bilinearmesh" "point3 P" [-0.4 0.95 -0.4  0.4 0.95 -0.4  -0.4 0.95 0.4  0.4 0.95 0.4]
    AttributeEnd
    "#,
    6,
    256,
);
