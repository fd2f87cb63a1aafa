//! What balls are made of: every kind of material, with textures, relief and holes.

/// A material of a ball.
pub struct Surface {
    pub name: &'static str,
    /// Directives that define what the others name.
    pub textures: &'static str,
    /// Directives before the ball's own shape.
    pub material: &'static str,
    /// Parameters of that shape.
    pub shape: &'static str,
}

const fn plain(name: &'static str, material: &'static str) -> Surface {
    textured(name, "", material)
}

const fn textured(name: &'static str, textures: &'static str, material: &'static str) -> Surface {
    Surface {
        name,
        textures,
        material,
        shape: "",
    }
}

/// All of them: three after another are a group, which stands in one scene.
pub static SURFACES: [Surface; 27] = [
    textured(
        "picture",
        r#"Texture "bricks" "spectrum" "imagemap" "string filename" "../scenes/parts/bricks.png" "float uscale" 3 "float vscale" 2"#,
        r#"Material "diffuse" "texture reflectance" "bricks""#,
    ),
    plain("rough metal", r#"Material "conductor" "float roughness" 0.3"#),
    plain("glass", r#"Material "dielectric" "float eta" 1.5"#),
    plain(
        "Oren-Nayar",
        r#"Material "diffuse" "rgb reflectance" [0.7 0.5 0.3] "float roughness" 0.8"#,
    ),
    plain("mirror", r#"Material "conductor" "rgb reflectance" [0.9 0.8 0.7]"#),
    plain(
        "rough glass",
        r#"Material "dielectric" "float eta" 1.5 "float roughness" 0.25"#,
    ),
    plain(
        "diffuse transmission",
        r#"Material "diffusetransmission" "rgb reflectance" [0.4 0.2 0.1] "rgb transmittance" [0.3 0.3 0.5]"#,
    ),
    plain(
        "anisotropic metal of Beckmann's facets",
        r#"Material "conductor" "spectrum eta" "metal-Al-eta" "spectrum k" "metal-Al-k" "float uroughness" 0.5
           "float vroughness" 0.15 "string distribution" "beckmann""#,
    ),
    plain(
        "glass of many bounces",
        r#"Material "dielectric" "float eta" 1.5 "float roughness" 0.5 "bool multiplescattering" true"#,
    ),
    plain(
        "smooth coat",
        r#"Material "coateddiffuse" "rgb reflectance" [0.6 0.4 0.2] "float roughness" 0"#,
    ),
    plain(
        "metal of many bounces",
        r#"Material "conductor" "float roughness" 0.6 "bool multiplescattering" true"#,
    ),
    plain("thin glass", r#"Material "thindielectric" "float eta" 1.5"#),
    plain(
        "rough coat",
        r#"Material "coateddiffuse" "rgb reflectance" [0.6 0.4 0.2] "float roughness" 0.3 "float thickness" 0.1
           "rgb albedo" [0.5 0.6 0.7] "float g" 0.3"#,
    ),
    plain(
        "principled",
        r#"Material "principled" "rgb base_color" [0.7 0.5 0.3] "float metallic" 0.4 "float roughness" 0.4 "float clearcoat" 0.4
           "float sheen" 0.5 "float anisotropic" 0.5"#,
    ),
    plain(
        "anisotropic glass of Beckmann's facets",
        r#"Material "dielectric" "float eta" 1.8 "float uroughness" 0.4 "float vroughness" 0.15 "string distribution" "beckmann""#,
    ),
    plain(
        "coated metal",
        r#"Material "coatedconductor" "float conductor.roughness" 0.2 "float interface.roughness" 0.2"#,
    ),
    plain(
        "principled glass",
        r#"Material "principled" "rgb base_color" [0.9 0.9 0.7] "float roughness" 0.5 "float spec_trans" 0.7"#,
    ),
    plain(
        "no surface, and one in it",
        r#"Material "diffuse" "rgb reflectance" [0.3 0.5 0.7] Shape "sphere" "float radius" 0.6 Material "interface""#,
    ),
    plain(
        "measured",
        r#"Material "measured" "string filename" "../scenes/parts/measured-ggx.bsdf""#,
    ),
    textured(
        "bumps",
        // Of one octave: finer ones are smoothed over the footprint of a camera path, and less on light paths.
        r#"Texture "dents" "float" "wrinkled" "integer octaves" 1
           Texture "heights" "float" "scale" "texture tex" "dents" "float scale" 0.1"#,
        r#"Material "conductor" "float roughness" 0.3 "texture displacement" "heights""#,
    ),
    plain(
        "glass that disperses",
        r#"Material "dielectric" "spectrum eta" "glass-F11""#,
    ),
    textured(
        "mix",
        r#"Texture "which" "float" "dots" "float uscale" 8 "float vscale" 4 "float inside" 0.2 "float outside" 0.8"#,
        r#"MakeNamedMaterial "paint" "string type" "diffuse" "rgb reflectance" [0.6 0.2 0.2]
           MakeNamedMaterial "metal" "string type" "conductor" "float roughness" 0.2
           Material "mix" "string materials" ["paint" "metal"] "texture amount" "which""#,
    ),
    textured(
        "normal map",
        "",
        r#"Material "coateddiffuse" "rgb reflectance" [0.5 0.6 0.3] "float roughness" 0.2
           "string normalmap" "../scenes/parts/bricks-normal.png""#,
    ),
    Surface {
        name: "holes",
        textures: r#"Texture "there" "float" "checkerboard" "float uscale" 8 "float vscale" 4 "float tex1" 0.3 "float tex2" 1"#,
        material: r#"Material "diffuse" "rgb reflectance" [0.7 0.7 0.4]"#,
        shape: r#""texture alpha" "there""#,
    },
    textured(
        "roughness by a pattern",
        r#"Texture "rough" "float" "checkerboard" "float uscale" 6 "float vscale" 4 "float tex1" 0.5 "float tex2" 0.8
           Texture "hue" "spectrum" "marble" "float scale" 2"#,
        r#"Material "principled" "texture roughness" "rough" "texture base_color" "hue" "float metallic" 0.9"#,
    ),
    textured(
        "glass with a normal map",
        "",
        r#"Material "dielectric" "float eta" 1.3 "float roughness" 0.3 "string normalmap" "../scenes/parts/bricks-normal.png""#,
    ),
    textured(
        "bumps on what light passes",
        r#"Texture "waves" "float" "windy" Texture "swell" "float" "scale" "texture tex" "waves" "float scale" 0.05"#,
        r#"Material "diffusetransmission" "rgb reflectance" [0.2 0.3 0.2] "rgb transmittance" [0.5 0.4 0.4]
           "texture displacement" "swell""#,
    ),
];

/// The directives of a material by its name.
pub fn material(name: &str) -> String {
    let surface = SURFACES.iter().find(|surface| surface.name == name);
    let surface = surface.unwrap_or_else(|| panic!("there is no surface `{name}`"));
    format!("{}\n{}", surface.textures, surface.material)
}
