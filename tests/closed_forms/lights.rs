//! Irradiance of spotlights, projected and goniometric images, skies, portals, textured and moving lights.

use std::f64::consts::PI;

use glam::DVec3;

use super::common::write_image;
use super::irradiance::{check_irradiance, check_with, polygon_irradiance};
use super::{options, quad};

/// A file with a grey picture, in columns and rows from the top; its path.
fn grey_image(name: &str, size: [usize; 2], value: impl Fn(usize, usize) -> f32) -> String {
    write_image(name, size, |x, y| [value(x, y); 3])
}

fn irradiance_of_point(p: DVec3, at: DVec3) -> f64 {
    let d = at - p;
    d.z / d.length().powi(3)
}

#[test]
fn a_spotlight_falls_off_by_a_smooth_step() {
    let (at, to) = (DVec3::new(0.5, -0.5, 3.0), DVec3::new(-0.2, 0.3, 0.0));
    let axis = (to - at).normalize();
    let smooth = |p: DVec3, angle: f64, delta: f64| {
        let cos = axis.dot((p - at).normalize());
        let (low, high) = (angle.to_radians().cos(), (angle - delta).to_radians().cos());
        if low >= high {
            return f64::from(cos >= low);
        }
        let t = ((cos - low) / (high - low)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    // The light is somewhere else and turned there.
    let light = |parameters: &str| {
        format!(
            "AttributeBegin\nTranslate 0 0 1\nRotate 180 1 0 0\nLightSource \"spot\" \"point3 from\" [0.5 0.5 -2] \
             \"point3 to\" [-0.2 -0.3 1] {parameters}\nAttributeEnd"
        )
    };
    for (angle, delta) in [(60.0, 60.0), (70.0, 20.0), (75.0, 40.0)] {
        let parameters = format!("\"float coneangle\" {angle} \"float conedeltaangle\" {delta} \"rgb I\" [9 9 9]");
        let options = options(1);
        check_with(
            &format!("spot {angle} {delta}"),
            1024,
            &options,
            &light(&parameters),
            |p| 9.0 * smooth(p, angle, delta) * irradiance_of_point(p, at),
        );
    }
    // Of 100 lm within a cone of 60 degrees all is intensity.
    let intensity = 100.0 / (2.0 * PI * 0.5);
    check_irradiance(
        "spot by power",
        1,
        &light("\"float coneangle\" 60 \"float conedeltaangle\" 0 \"float power\" 100"),
        |p| intensity * smooth(p, 60.0, 0.0) * irradiance_of_point(p, at),
    );
}

#[test]
fn a_goniometric_image_is_intensity_by_direction() {
    let at = DVec3::new(0.5, -0.5, 2.0);
    let light = |file: &str, parameters: &str| {
        format!(
            "AttributeBegin\nTranslate 0.5 -0.5 2\nRotate 90 1 0 0\nLightSource \"goniometric\" \"string filename\" \"{file}\" {parameters}\n\
             AttributeEnd"
        )
    };
    let flat = grey_image("goniometric-flat", [1, 1], |_, _| 0.5);
    check_irradiance("goniometric, flat", 1, &light(&flat, "\"rgb I\" [8 8 8]"), |p| {
        4.0 * irradiance_of_point(p, at)
    });
    check_irradiance(
        "goniometric, flat, by power",
        1,
        &light(&flat, &format!("\"float power\" {}", 4.0 * PI * 3.0)),
        |p| 3.0 * irradiance_of_point(p, at),
    );
    // The image's pole is the light's +y, which is +z here: the inner square of the image is what goes up. The corners are the four
    // quarters below, each of one brightness: columns along x, rows along the third axis.
    let quarters = grey_image("goniometric-quarters", [2, 2], |x, y| (1 + x + 2 * y) as f32);
    check_irradiance(
        "goniometric, quarters",
        1,
        &light(&quarters, "\"rgb I\" [2 2 2]"),
        |p| {
            // Turned by 90 degrees about x, the light's z is the world's -y.
            let d = p - at;
            let (column, row) = (f64::from(d.x > 0.0), f64::from(-d.y > 0.0));
            2.0 * (1.0 + column + 2.0 * row) * irradiance_of_point(p, at)
        },
    );
}

#[test]
fn a_projection_throws_its_picture_upright() {
    let at = DVec3::new(0.0, 0.0, 2.35);
    // Looking down with +y of the light to +y of the world, +x is to -x of the world (a turn by 180 degrees about y).
    let light = |file: &str, parameters: &str| {
        format!(
            "AttributeBegin\nTranslate 0 0 2.35\nRotate 180 0 1 0\nLightSource \"projection\" \"string filename\" \"{file}\" \
             \"float fov\" 53.13010235415598 {parameters}\nAttributeEnd"
        )
    };
    // Three columns, two rows: the angle is that of the height.
    let value = |x: usize, y: usize| (1 + x + 3 * y) as f32;
    let file = grey_image("projection", [3, 2], value);
    // At half the height: its edges are where the quadrature finds them.
    let half = 0.5;
    let picture = |p: DVec3| {
        let d = (p - at) / 2.0;
        let (x, y) = ((-d.x / (1.5 * half) + 1.0) * 1.5, (1.0 - d.y / half) * 1.0);
        let inside = (0.0..3.0).contains(&x) && (0.0..2.0).contains(&y);
        if inside {
            f64::from(value(x as usize, y as usize))
        } else {
            0.0
        }
    };
    check_with(
        "projection",
        4096,
        &options(1),
        &light(&file, "\"float scale\" 3"),
        |p| 3.0 * picture(p) * irradiance_of_point(p, at),
    );
    // By power: the flux of the picture is that through its rectangle at distance 1, by quadrature.
    let flux = super::mean_over([-1.5 * half, 1.5 * half], [-half, half], |x, y| {
        let d = DVec3::new(-x, y, -1.0);
        picture(at + 2.0 * d) / d.length().powi(3)
    }) * 6.0
        * half
        * half;
    check_with(
        "projection by power",
        4096,
        &options(1),
        &light(&file, "\"float power\" 20"),
        |p| 20.0 / flux * picture(p) * irradiance_of_point(p, at),
    );
}

#[test]
fn a_sky_image_of_one_value_is_a_constant_sky() {
    for (name, size) in [("sky-square", [4, 4]), ("sky-wide", [8, 4])] {
        let file = grey_image(name, size, |_, _| 0.75);
        let light = format!("LightSource \"infinite\" \"string filename\" \"{file}\" \"float scale\" 2");
        check_irradiance(name, 1, &light, |_| 1.5 * PI);
    }
}

/// A sky with one bright quarter, which a turn brings overhead, and the same from either map.
#[test]
fn a_sky_image_is_turned_with_its_light() {
    // Latitude and longitude: the upper row is the hemisphere about +z, columns are quarters from +x towards +y.
    let wide = grey_image("sky-quarters", [4, 2], |x, y| if (x, y) == (1, 0) { 3.0 } else { 0.5 });
    let light = |turn: &str| {
        format!("AttributeBegin\n{turn}\nLightSource \"infinite\" \"string filename\" \"{wide}\"\nAttributeEnd")
    };
    // A quarter of the hemisphere gives a quarter of its irradiance.
    check_irradiance("sky, quarter above", 1, &light(""), |_| PI * (0.75 * 0.5 + 0.25 * 3.0));
    check_irradiance("sky, quarter below", 1, &light("Rotate 180 1 0 0"), |_| PI * 0.5);
    // Turned by 90 degrees about y the octant x < 0, y > 0, z > 0 goes to x > 0, y > 0, z > 0: again above.
    check_irradiance("sky, quarter turned", 1, &light("Rotate 90 0 1 0"), |_| {
        PI * (0.75 * 0.5 + 0.25 * 3.0)
    });
    // Equal areas: quarters of the image are quarters of the sphere about the axis. As pbrt-v4 counts it, half of the illuminance
    // is what is asked for.
    let square = grey_image(
        "sky-corners",
        [64, 64],
        |x, y| if x < 32 && y >= 32 { 3.0 } else { 0.5 },
    );
    let light = format!("LightSource \"infinite\" \"string filename\" \"{square}\" \"float illuminance\" 10");
    check_irradiance("sky by illuminance", 1, &light, |_| 20.0);
}

/// A uniform sky through a portal lights as its rectangle would.
#[test]
fn a_portal_lights_as_a_window() {
    let corners = [
        DVec3::new(-1.0, -0.5, 2.5),
        DVec3::new(0.5, -0.5, 2.5),
        DVec3::new(0.5, 1.5, 2.5),
        DVec3::new(-1.0, 1.5, 2.5),
    ];
    // Seen from below: (p3 - p0) x (p1 - p0) points up.
    let order = [0, 3, 2, 1].map(|i| {
        let DVec3 { x, y, z } = corners[i];
        format!("{x} {y} {z}")
    });
    let portal = format!("\"point3 portal\" [{}]", order.join("  "));
    let expected = |l: f64| move |p: DVec3| l * polygon_irradiance(p, DVec3::Z, &corners);
    let light = format!("LightSource \"infinite\" \"rgb L\" [3 3 3] {portal}");
    check_irradiance("portal", 1, &light, expected(3.0));
    for (name, size) in [("portal-square", [3, 3]), ("portal-wide", [4, 2])] {
        let file = grey_image(name, size, |_, _| 3.0);
        let light = format!("LightSource \"infinite\" \"string filename\" \"{file}\" {portal}");
        check_irradiance(name, 1, &light, expected(3.0));
    }
}

/// A lamp whose left half is black lights as its right half.
#[test]
fn an_image_on_a_lamp_is_where_its_coordinates_are() {
    // Many columns: between the middles of the two at the edge it is not sharp, but symmetric about it.
    let file = grey_image("lamp", [256, 2], |x, y| if x < 128 { 0.0 } else { 1.0 + y as f32 });
    let (corner, a, b) = (
        DVec3::new(-1.0, -0.5, 2.5),
        DVec3::new(0.0, 2.0, 0.0),
        DVec3::new(1.5, 0.0, 0.0),
    );
    let light = format!(
        "AttributeBegin\nAreaLightSource \"diffuse\" \"string filename\" \"{file}\" \"float scale\" 3\n\
         Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{}AttributeEnd",
        quad(corner.to_array(), a.to_array(), b.to_array())
    );
    // u along a, v along b; rows from the top, 1 above and 2 below: linear from 2 at v = 1/4 to 1 at v = 3/4.
    check_with("lamp with an image", 1024, &options(1), &light, |p| {
        mean_of_strips([0.0, 1.0], |v| {
            let value = 2.0 - ((v - 0.25) / 0.5).clamp(0.0, 1.0);
            let (thin, start) = (b / STRIPS as f64, corner + 0.5 * a + b * (v - 0.5 / STRIPS as f64));
            let strip = [start, start + 0.5 * a, start + 0.5 * a + thin, start + thin];
            3.0 * value * polygon_irradiance(p, DVec3::Z, &strip) * STRIPS as f64
        })
    });
}

const STRIPS: usize = 32;

fn mean_of_strips([x0, x1]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let points = (0..STRIPS).map(|i| f(x0 + (x1 - x0) * (i as f64 + 0.5) / STRIPS as f64));
    points.sum::<f64>() / STRIPS as f64
}

#[test]
fn lights_that_move_light_from_where_they_are() {
    const STEPS: usize = 64;
    let mean =
        |f: &dyn Fn(f64) -> f64| (0..STEPS).map(|i| f((i as f64 + 0.5) / STEPS as f64)).sum::<f64>() / STEPS as f64;
    let moving = |motion: &str, light: &str| {
        format!("AttributeBegin\nActiveTransform EndTime\n{motion}\nActiveTransform All\n{light}\nAttributeEnd")
    };
    // A point that passes over.
    let light = moving(
        "Translate 2 0 0",
        "LightSource \"point\" \"point3 from\" [-1 0.5 2] \"rgb I\" [6 6 6]",
    );
    check_with("moving point", 1024, &options(1), &light, |p| {
        mean(&|t| 6.0 * irradiance_of_point(p, DVec3::new(-1.0 + 2.0 * t, 0.5, 2.0)))
    });
    // A sphere that passes over, by an instance's transform.
    let light = moving(
        "Translate 2 0 1",
        "AreaLightSource \"diffuse\" \"rgb L\" [4 4 4]\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n\
         Translate -1 0.5 2\nShape \"sphere\" \"float radius\" 0.4",
    );
    check_with("moving sphere", 1024, &options(1), &light, |p| {
        mean(&|t| 4.0 * PI * 0.16 * irradiance_of_point(p, DVec3::new(-1.0 + 2.0 * t, 0.5, 2.0 + t)))
    });
    // A rectangle that turns about x, and one whose vertices move.
    let rectangle = |z: [f64; 2]| [(-1.0, z[0]), (1.0, z[0]), (1.0, z[1]), (-1.0, z[1])];
    let at = |corners: [(f64, f64); 4], y: f64| {
        let ys = [-y, -y, y, y];
        std::array::from_fn::<DVec3, 4, _>(|i| DVec3::new(corners[i].0, ys[i], corners[i].1))
    };
    let text = |corners: &[DVec3]| {
        let points = corners.iter().map(|p| format!("{} {} {}", p.x, p.y, p.z));
        points.collect::<Vec<_>>().join("  ")
    };
    let [start, end] = [at(rectangle([2.0, 2.5]), 0.5), at(rectangle([3.0, 2.0]), 1.0)];
    let light = format!(
        "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [4 4 4] \"bool twosided\" true\n\
         Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \
         \"point3 P\" [{}] \"point3 P1\" [{}]\nAttributeEnd",
        text(&start),
        text(&end)
    );
    check_with("moving vertices", 1024, &options(1), &light, |p| {
        mean(&|t| {
            let now: [DVec3; 4] = std::array::from_fn(|i| start[i].lerp(end[i], t));
            4.0 * polygon_irradiance(p, DVec3::Z, &now)
        })
    });
    let flat = at(rectangle([0.0, 0.0]), 0.6);
    let light = format!(
        "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [4 4 4] \"bool twosided\" true\n\
         Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nTranslate 0 0 2.5\nActiveTransform EndTime\nRotate 80 1 0 0\n\
         ActiveTransform All\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [{}]\nAttributeEnd",
        text(&flat)
    );
    check_with("turning rectangle", 1024, &options(1), &light, |p| {
        mean(&|t| {
            let (sin, cos) = (80_f64.to_radians() * t).sin_cos();
            let now = flat.map(|q| DVec3::new(q.x, q.y * cos, q.y * sin + 2.5));
            4.0 * polygon_irradiance(p, DVec3::Z, &now)
        })
    });
}

/// An ellipsoid overhead: by quadrature over its surface.
#[test]
fn an_ellipsoid_lights_by_what_is_seen_of_it() {
    let center = DVec3::new(0.3, -0.2, 2.5);
    let axes = DVec3::new(1.2, 0.4, 0.7);
    let light = "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [3 3 3]\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n\
                 Translate 0.3 -0.2 2.5\nScale 2.4 0.8 1.4\nShape \"sphere\" \"float radius\" 0.5\nAttributeEnd";
    check_with("ellipsoid", 1024, &options(1), light, |p| {
        const N: usize = 24;
        let mut sum = 0.0;
        for i in 0..2 * N * N {
            let z = 1.0 - 2.0 * ((i / (2 * N)) as f64 + 0.5) / N as f64;
            let (sin, cos) = (PI * ((i % (2 * N)) as f64 + 0.5) / N as f64).sin_cos();
            let unit = DVec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z);
            // The element of area is the product of the axes times unit / axes.
            let element = axes.x * axes.y * axes.z * unit / axes * (4.0 * PI / (2 * N * N) as f64);
            let to = center + axes * unit - p;
            let facing = (-element.dot(to)).max(0.0);
            sum += 3.0 * facing * to.z / to.length_squared().powi(2);
        }
        sum
    });
}

/// Light along the normals: of a rectangle a beam of its own cross-section, of a sphere what a point of the same flux gives.
#[test]
fn light_along_normals_is_a_beam() {
    let light = |shape: &str, parameters: &str| {
        format!(
            "AttributeBegin\nAreaLightSource \"diffuse\" \"string spread\" \"normal\" {parameters}\n\
             Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{shape}AttributeEnd"
        )
    };
    let integrated_by = |name: &str| options(1).replace("\"path\"", &format!("\"{name}\""));
    // Facing down: over blocks of the picture from -1 to 2 and from -2 to 0.
    let square = quad([-1.0, -2.0, 3.0], [0.0, 2.0, 0.0], [3.0, 0.0, 0.0]);
    let in_beam = |p: DVec3| f64::from(p.x > -1.0 && p.x < 2.0 && p.y > -2.0 && p.y < 0.0);
    for name in ["bdpt", "lightpath"] {
        let options = integrated_by(name);
        let beam = light(&square, "\"rgb L\" [3 3 3]");
        check_with(&format!("beam by {name}"), 1024, &options, &beam, |p| 3.0 * in_beam(p));
        // The power of each of two triangles of 3 units of area.
        let beam = light(&square, "\"float power\" 6 \"bool twosided\" true");
        check_with(&format!("beam by power, {name}"), 1024, &options, &beam, in_beam);
        let center = DVec3::new(0.5, -0.5, 2.5);
        let sphere = "Translate 0.5 -0.5 2.5 Shape \"sphere\" \"float radius\" 0.2\n";
        let rays = light(sphere, "\"rgb L\" [100 100 100]");
        check_with(&format!("sphere along normals by {name}"), 4096, &options, &rays, |p| {
            4.0 * irradiance_of_point(p, center)
        });
    }
    // A given point is on none of these normals: light samples and rays that meet the light find nothing.
    let path = light(&square, "\"rgb L\" [3 3 3]");
    check_with("beam by path", 16, &options(1), &path, |_| 0.0);
}
