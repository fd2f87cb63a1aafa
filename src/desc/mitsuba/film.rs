//! Films and their filters.

use super::graph::Object;
use super::loader::Loader;
use super::plugins::Class;
use super::props::Props;
use crate::desc::{
    ColorSpace, CropDesc, FilmDesc, FilmKind, FilterDesc, FilterKind, MeasureDesc, PixelRect, SensorDesc,
};
use crate::error::Span;

/// A film and the filter of its pixels.
pub(super) struct Picture {
    pub film: FilmDesc,
    pub filter: FilterDesc,
}

impl Picture {
    /// What a sensor without a film has.
    pub fn default_at(span: Span) -> Self {
        Self {
            film: FilmDesc {
                resolution: [768, 576],
                crop: CropDesc::Full,
                diagonal: 35.0,
                kind: FilmKind::Rgb,
                filename: None,
                iso: 100.0,
                exposure_time: 1.0,
                sensor: SensorDesc::Cie1931,
                white_balance: None,
                max_component: f64::INFINITY,
                color_space: ColorSpace::Srgb,
                measure: MeasureDesc::Radiance,
                span,
            },
            filter: gaussian(0.5),
        }
    }
}

impl<'g> Loader<'g> {
    /// A film.
    pub fn film(&mut self, object: &'g Object) -> Picture {
        let mut picture = Picture::default_at(object.span);
        let mut props = Props::new(object);
        if object.plugin != "hdrfilm" {
            self.refuse(object, "it is taken for `hdrfilm`");
            props.objects(|_| true);
            return picture;
        }
        let [width, height] = picture.film.resolution;
        picture.film.resolution = [side(&mut props, "width", width), side(&mut props, "height", height)];
        picture.film.crop = crop(&mut props, picture.film.resolution);
        props.inert(&[
            ("file_format", "the name of the output says the format"),
            ("component_format", "EXR files have 32-bit floating-point numbers"),
            ("banner", "there are no banners"),
        ]);
        if let Some(format) = props.string("pixel_format")
            && format != "rgb"
        {
            props.warning(
                props.span_of("pixel_format"),
                format!("`pixel_format` is `{format}`: pictures are rgb here"),
            );
        }
        if props.boolean("sample_border", false) {
            props.inert(&[(
                "sample_border",
                "pixels at the border always see what is beside the picture",
            )]);
        }
        props.ignore(&["compensate"]);
        let filter = self.child(&mut props, Class::Filter);
        props.finish(self.report());
        if let Some((_, filter)) = filter {
            let mut props = Props::new(filter);
            picture.filter = read_filter(&mut props);
            props.finish(self.report());
        }
        picture
    }
}

/// The longest side of a picture.
const LONGEST_SIDE: u32 = 1 << 16;

fn side(props: &mut Props<'_>, name: &'static str, default: u32) -> u32 {
    let side = props.count(name, 1, default);
    if side <= LONGEST_SIDE {
        return side;
    }
    props.error(
        props.span_of(name),
        format!("`{name}` is {side}; expected at most {LONGEST_SIDE}"),
    );
    default
}

fn crop(props: &mut Props<'_>, [width, height]: [u32; 2]) -> CropDesc {
    const NAMES: [&str; 4] = ["crop_offset_x", "crop_offset_y", "crop_width", "crop_height"];
    if !NAMES.iter().any(|name| props.has(name)) {
        return CropDesc::Full;
    }
    let x0 = props.count(NAMES[0], 0, 0);
    let y0 = props.count(NAMES[1], 0, 0);
    let x1 = x0.saturating_add(props.count(NAMES[2], 1, width.saturating_sub(x0).max(1)));
    let y1 = y0.saturating_add(props.count(NAMES[3], 1, height.saturating_sub(y0).max(1)));
    if x1 > width || y1 > height {
        let message =
            format!("the crop, {x0} to {x1} by {y0} to {y1}, is not all in the picture of {width} x {height} pixels");
        props.error(props.object.span, message);
        return CropDesc::Full;
    }
    CropDesc::Pixels(PixelRect { x0, y0, x1, y1 })
}

fn read_filter(props: &mut Props<'_>) -> FilterDesc {
    let of = |kind, radius: f64| FilterDesc {
        kind,
        radius: [radius; 2],
    };
    match props.object.plugin.as_str() {
        "box" => of(FilterKind::Box, props.positive("radius", 0.5)),
        "tent" => of(FilterKind::Triangle, props.positive("radius", 1.0)),
        "mitchell" => {
            let [b, c] = ["B", "C"].map(|name| props.float(name).unwrap_or(1.0 / 3.0));
            of(FilterKind::Mitchell { b, c }, 2.0)
        }
        "catmullrom" => of(FilterKind::Mitchell { b: 0.0, c: 0.5 }, 2.0),
        "lanczos" => {
            let lobes = f64::from(props.count("lobes", 1, 3));
            of(FilterKind::LanczosSinc { tau: lobes }, lobes)
        }
        _ => gaussian(props.positive("stddev", 0.5)),
    }
}

/// Cut off at four standard deviations.
fn gaussian(sigma: f64) -> FilterDesc {
    FilterDesc {
        kind: FilterKind::Gaussian { sigma },
        radius: [4.0 * sigma; 2],
    }
}
