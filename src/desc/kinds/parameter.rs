//! Parameters as the reader knows them: name, type, range, default and meaning of each in one place, which the reader reads its
//! values by and `lucerna list` prints.

use crate::image_io::Encoding;

/// A parameter of a kind of entity.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// As in a scene file.
    pub name: &'static str,
    /// What values it takes.
    pub kind: ParameterKind,
    /// The unit of its numbers; empty if they are pure numbers, colours or words.
    pub unit: &'static str,
    /// What it does, in a sentence without a full stop.
    pub doc: &'static str,
}

impl Parameter {
    pub(super) const fn new(name: &'static str, kind: ParameterKind, doc: &'static str) -> Self {
        let unit = "";
        Self { name, kind, unit, doc }
    }

    pub(super) const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    pub(super) const fn float(name: &'static str, default: f64, range: FloatRange, doc: &'static str) -> Self {
        Self::new(name, ParameterKind::Float { default, range }, doc)
    }

    pub(super) const fn integer(name: &'static str, default: i32, range: (i32, i32), doc: &'static str) -> Self {
        Self::new(name, ParameterKind::Integer { default, range }, doc)
    }

    pub(super) const fn flag(name: &'static str, default: bool, doc: &'static str) -> Self {
        Self::new(name, ParameterKind::Bool(default), doc)
    }

    /// One of a few words, the first by default.
    pub(super) const fn choice(name: &'static str, choices: &'static [&'static str], doc: &'static str) -> Self {
        let default = choices[0];
        Self::new(name, ParameterKind::Choice { default, choices }, doc)
    }

    pub(super) const fn file(name: &'static str, doc: &'static str) -> Self {
        Self::new(name, ParameterKind::File, doc)
    }

    pub(super) const fn value(name: &'static str, default: f64, doc: &'static str) -> Self {
        Self::new(name, ParameterKind::Value { default }, doc)
    }

    pub(super) const fn textured(name: &'static str, default: f64, doc: &'static str) -> Self {
        Self::new(name, ParameterKind::Textured { default }, doc)
    }

    /// One of pbrt's that changes nothing here; `doc` says why.
    pub(super) const fn inert(name: &'static str, r#type: &'static str, doc: &'static str) -> Self {
        Self::new(name, ParameterKind::Inert(r#type), doc)
    }
}

/// What values a parameter takes, and which one stands in where none is given.
#[derive(Clone, Copy, Debug)]
pub enum ParameterKind {
    /// `bool`.
    Bool(bool),
    /// `integer`.
    Integer {
        /// If none is given.
        default: i32,
        /// The least and the greatest value.
        range: (i32, i32),
    },
    /// `float`.
    Float {
        /// If none is given.
        default: f64,
        /// What is allowed.
        range: FloatRange,
    },
    /// `vector3`.
    Vector([f64; 3]),
    /// `point3`.
    Point([f64; 3]),
    /// `point3`: so many of them; there is no default.
    Points(usize),
    /// The spectrum of a light: `rgb`, `spectrum` or `blackbody`; by default the colour space's illuminant.
    Emission,
    /// A spectrum that is no emission of a light: `rgb`, `spectrum` or `blackbody`, 0 or more.
    Spectrum {
        /// If none is given, at all wavelengths.
        default: f64,
    },
    /// `float`: a power or an illuminance, which counts if it is positive; there is no default.
    Photometric,
    /// `string`: one of a few words.
    Choice {
        /// If none is given.
        default: &'static str,
        /// All of them.
        choices: &'static [&'static str],
    },
    /// `string`: the curve of an image's integer samples.
    Encoding {
        /// If none is given.
        default: Encoding,
    },
    /// `string`: the name of a file; there is no default.
    File,
    /// The value of a texture: `float`, or for a spectrum texture `rgb`, `spectrum` or `blackbody`.
    Value {
        /// If none is given; of a spectrum, at all wavelengths.
        default: f64,
    },
    /// As [`ParameterKind::Value`], or the name of a `texture` of the same class.
    Textured {
        /// If none is given; of a spectrum, at all wavelengths.
        default: f64,
    },
    /// `float` or the name of a float `texture`.
    FloatTextured {
        /// If none is given.
        default: f64,
    },
    /// As [`ParameterKind::FloatTextured`], where a plain number is limited.
    FloatTexturedIn {
        /// If none is given.
        default: ParameterDefault,
        /// What is allowed.
        range: FloatRange,
    },
    /// `rgb`, `spectrum` or the name of a spectrum `texture`, in [0, 1].
    Reflectance {
        /// If none is given, at all wavelengths.
        default: Option<f64>,
    },
    /// `spectrum`, `rgb` or the name of a spectrum `texture`: the real part of a metal's index of refraction.
    MetalIndex {
        /// The name of the spectrum if none is given.
        default: &'static str,
    },
    /// As [`ParameterKind::MetalIndex`], of the imaginary part.
    MetalAbsorption {
        /// The name of the spectrum if none is given.
        default: &'static str,
    },
    /// `spectrum`, `rgb` or the name of a spectrum `texture`: absorption, not negative; there is no default.
    Absorption,
    /// `float` or the name of a float `texture`: how much there is of a pigment, not negative; there is no default.
    Pigment,
    /// `float` or `spectrum`: the index of refraction of a dielectric.
    GlassIndex {
        /// If none is given, at all wavelengths.
        default: f64,
    },
    /// `string`: the name of a named material; there is no default.
    Material,
    /// `string`: the name of an attribute of meshes; there is no default.
    Attribute,
    /// `string`: the names of two named materials; there is no default.
    TwoMaterials,
    /// A parameter of pbrt's, of this type, that has no effect; not more than its presence is looked at.
    Inert(&'static str),
}

/// What stands in for a number that is not given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParameterDefault {
    /// A number.
    Number(f64),
    /// The value of the parameter of this name.
    Of(&'static str),
}

/// Which numbers are allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FloatRange {
    /// All finite ones.
    Any,
    /// 0 or more.
    NotNegative,
    /// More than 0.
    Positive,
    /// The probability of ending a path, from 0.05 to 0.95.
    Ending,
    /// 1 or more.
    AtLeastOne,
    /// From 0 to 1.
    Unit,
    /// Between -1 and 1, both excluded.
    Asymmetry,
    /// An angle of more than 0 and at most 180 degrees.
    HalfTurn,
    /// An angle of more than 0 and less than 180 degrees.
    FieldOfView,
}

impl FloatRange {
    /// Whether a value is allowed.
    pub fn contains(self, value: f64) -> bool {
        match self {
            Self::Any => true,
            Self::NotNegative => value >= 0.0,
            Self::Positive => value > 0.0,
            Self::Ending => (0.05..=0.95).contains(&value),
            Self::AtLeastOne => value >= 1.0,
            Self::Unit => (0.0..=1.0).contains(&value),
            Self::Asymmetry => value.abs() < 1.0,
            Self::HalfTurn => value > 0.0 && value <= 180.0,
            Self::FieldOfView => value > 0.0 && value < 180.0,
        }
    }

    /// Completes "must be".
    pub fn text(self) -> &'static str {
        match self {
            Self::Any => "finite",
            Self::NotNegative => "0 or more",
            Self::Positive => "positive",
            Self::Ending => "between 0.05 and 0.95",
            Self::AtLeastOne => "1 or more",
            Self::Unit => "between 0 and 1",
            Self::Asymmetry => "more than -1 and less than 1",
            Self::HalfTurn => "more than 0 and at most 180",
            Self::FieldOfView => "more than 0 and less than 180",
        }
    }
}

impl ParameterKind {
    /// The types that a scene file may give it. Of `float` and those of spectra, a [`ParameterKind::Value`] and a
    /// [`ParameterKind::Textured`] take those of the texture's class.
    pub fn types(&self) -> &[&'static str] {
        match self {
            Self::Bool(_) => &["bool"],
            Self::Integer { .. } => &["integer"],
            Self::Float { .. } | Self::Photometric => &["float"],
            Self::Vector(_) => &["vector3"],
            Self::Point(_) | Self::Points(_) => &["point3"],
            Self::Emission | Self::Spectrum { .. } => &["rgb", "spectrum", "blackbody"],
            Self::Choice { .. }
            | Self::Encoding { .. }
            | Self::File
            | Self::Material
            | Self::Attribute
            | Self::TwoMaterials => &["string"],
            Self::Value { .. } => &["float", "rgb", "spectrum", "blackbody"],
            Self::Textured { .. } => &["float", "rgb", "spectrum", "blackbody", "texture"],
            Self::FloatTextured { .. } | Self::FloatTexturedIn { .. } | Self::Pigment => &["float", "texture"],
            Self::Reflectance { .. } | Self::MetalIndex { .. } | Self::MetalAbsorption { .. } | Self::Absorption => {
                &["rgb", "spectrum", "blackbody", "texture"]
            }
            Self::GlassIndex { .. } => &["float", "spectrum"],
            Self::Inert(name) => std::slice::from_ref(name),
        }
    }

    /// The values that are allowed, for people.
    pub fn range_text(&self) -> String {
        match self {
            Self::Bool(_) => "true, false".to_owned(),
            Self::Integer { range, .. } if range.1 == i32::MAX => format!("{} or more", range.0),
            Self::Integer { range, .. } => format!("{} to {}", range.0, range.1),
            Self::Float { range, .. } | Self::FloatTexturedIn { range, .. } => range.text().to_owned(),
            Self::Reflectance { .. } => FloatRange::Unit.text().to_owned(),
            Self::GlassIndex { .. } => FloatRange::Positive.text().to_owned(),
            Self::MetalIndex { .. } | Self::MetalAbsorption { .. } | Self::Absorption | Self::Pigment => {
                FloatRange::NotNegative.text().to_owned()
            }
            Self::Material | Self::Attribute => "a name".to_owned(),
            Self::TwoMaterials => "two names".to_owned(),
            Self::Choice { choices, .. } => choices.join(", "),
            Self::Encoding { .. } => "sRGB, linear, \"gamma G\" with G more than 0".to_owned(),
            Self::Inert(_) => "any; it has no effect".to_owned(),
            Self::File => "a file".to_owned(),
            Self::Points(count) => format!("{count} points"),
            Self::Emission | Self::Spectrum { .. } => "0 or more".to_owned(),
            Self::Photometric => "positive".to_owned(),
            Self::Vector(_) | Self::Point(_) | Self::FloatTextured { .. } => "finite".to_owned(),
            Self::Value { .. } | Self::Textured { .. } => "finite; of a spectrum 0 or more".to_owned(),
        }
    }

    /// The default, as a scene file would write it; empty if there is none.
    pub fn default_text(&self) -> String {
        match self {
            Self::Bool(default) => default.to_string(),
            Self::Integer { default, .. } => default.to_string(),
            Self::Float { default, .. }
            | Self::Value { default }
            | Self::Spectrum { default }
            | Self::Textured { default }
            | Self::FloatTextured { default }
            | Self::GlassIndex { default } => default.to_string(),
            Self::FloatTexturedIn { default, .. } => match default {
                ParameterDefault::Number(default) => default.to_string(),
                ParameterDefault::Of(name) => format!("that of {name}"),
            },
            Self::Reflectance { default } => default.map_or(String::new(), |default| default.to_string()),
            Self::Encoding { default } => default.to_string(),
            Self::MetalIndex { default } | Self::MetalAbsorption { default } => (*default).to_owned(),
            Self::Vector([x, y, z]) | Self::Point([x, y, z]) => format!("[ {x} {y} {z} ]"),
            Self::Choice { default, .. } => (*default).to_owned(),
            Self::Emission => "the colour space's illuminant".to_owned(),
            Self::File
            | Self::Material
            | Self::Attribute
            | Self::TwoMaterials
            | Self::Points(_)
            | Self::Photometric
            | Self::Absorption
            | Self::Pigment
            | Self::Inert(_) => String::new(),
        }
    }
}
