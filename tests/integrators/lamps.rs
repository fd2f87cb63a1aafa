//! What scenes are lit by: every kind of light, some of them together.

use std::sync::OnceLock;

use crate::common::write_image;

/// Lights of a scene.
pub struct Lamp {
    pub name: &'static str,
    /// Whether some of it is found by no direction.
    pub is_delta: bool,
    /// Directives of lights that may move.
    pub lights: &'static str,
    /// Directives of others.
    pub fixed: &'static str,
}

/// All of them. None is so small that directions drawn without knowing of it would hardly meet it. `@square` and `@wide` stand for images.
pub static LAMPS: [Lamp; 6] = [
    Lamp {
        name: "area",
        is_delta: false,
        lights: r#"AttributeBegin AreaLightSource "diffuse" "rgb L" [2 2.2 2.4]
            Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-5 3.5 -3  5 3.5 -3  5 3.5 3  -5 3.5 3] AttributeEnd"#,
        fixed: "",
    },
    Lamp {
        name: "two-sided picture and warm sphere",
        is_delta: false,
        lights: r#"AttributeBegin AreaLightSource "diffuse" "string filename" "@square" "bool twosided" true "float scale" 2
            Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-6 1 4  6 1 4  6 5 3  -6 5 3] "point2 uv" [0 0 1 0 1 1 0 1]
            AttributeEnd
            AttributeBegin AreaLightSource "diffuse" "blackbody L" 3200 "float power" 50 Translate -1 4 -3
            Shape "sphere" "float radius" 1.5 AttributeEnd"#,
        fixed: "",
    },
    Lamp {
        name: "point and spot",
        is_delta: true,
        lights: r#"LightSource "point" "point3 from" [-1.5 3 -2] "rgb I" [9 8 7]
            LightSource "spot" "point3 from" [1.5 5 -2] "point3 to" [0 0 0] "float coneangle" 40 "float conedeltaangle" 15
            "rgb I" [26 25 34]"#,
        fixed: "",
    },
    Lamp {
        name: "goniometric, projection and distant",
        is_delta: true,
        lights: r#"AttributeBegin Translate -2 3 -2.5 Rotate 30 1 1 0
            LightSource "goniometric" "string filename" "@square" "rgb I" [8 9 7] AttributeEnd
            AttributeBegin Translate 2 5 -3 Rotate 60 1 0 0
            LightSource "projection" "string filename" "@wide" "float fov" 50 "float scale" 20 AttributeEnd
            LightSource "distant" "point3 from" [1 2 -1] "point3 to" [0 0 0] "rgb L" [1 0.9 0.7]"#,
        fixed: "",
    },
    Lamp {
        name: "square sky and plain sky",
        is_delta: false,
        lights: r#"AttributeBegin Rotate 70 1 0.2 0
            LightSource "infinite" "string filename" "@square" AttributeEnd
            LightSource "infinite" "rgb L" [0.2 0.25 0.3]"#,
        fixed: "",
    },
    Lamp {
        name: "wide sky and portal",
        is_delta: false,
        lights: r#"AttributeBegin Rotate -90 1 0 0
            LightSource "infinite" "string filename" "@wide" "float scale" 0.4 AttributeEnd"#,
        fixed: r#"LightSource "infinite" "string filename" "@square" "float scale" 2
            "point3 portal" [-5 4 -4  -5 4 4  5 4 4  5 4 -4]"#,
    },
];

impl Lamp {
    /// The directives, with the lights moved at the end of the shutter by the directives `motion`.
    pub fn text(&self, motion: &str) -> String {
        let Self { lights, fixed, .. } = self;
        let [square, wide] = images();
        let text = format!("AttributeBegin {motion} {lights} AttributeEnd\n{fixed}");
        text.replace("@square", square).replace("@wide", wide)
    }
}

/// Pictures that are bright at one place, of different colours elsewhere: a square one and a wide one.
fn images() -> &'static [String; 2] {
    static PATHS: OnceLock<[String; 2]> = OnceLock::new();
    PATHS.get_or_init(|| {
        [("lamps-square", [16, 16]), ("lamps-wide", [16, 8])].map(|(name, [width, height])| {
            write_image(name, [width, height], |x, y| {
                let (u, v) = (x as f32 / width as f32, y as f32 / height as f32);
                let peak = 2.0 * (-20.0 * ((u - 0.4).powi(2) + (v - 0.4).powi(2))).exp();
                [0.3 + u + peak, 0.6 + peak, 0.3 + v + peak]
            })
        })
    })
}
