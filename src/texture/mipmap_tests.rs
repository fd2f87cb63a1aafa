use super::*;
use crate::image_io::Window;

fn map(width: usize, height: usize, wrap: Wrap, value: impl Fn(usize, usize) -> [f32; 3]) -> MipMap {
    let window = Window::of_size(width as i32, height as i32);
    let data = (0..width * height).flat_map(|i| value(i % width, i / width)).collect();
    let image = Image::rgb(window, window, data).expect("an image");
    MipMap::new(&Arc::new(image), wrap, false).expect("colour")
}

/// Red counts columns, green rows.
fn ramp(wrap: Wrap) -> MipMap {
    map(4, 2, wrap, |x, y| [x as f32, y as f32, 1.0])
}

fn at(map: &MipMap, s: f32, t: f32, filter: Filter) -> Vec3 {
    map.lookup(Vec2::new(s, t), Vec2::ZERO, Vec2::ZERO, filter)
}

#[test]
fn texels_are_at_their_centres() {
    let map = ramp(Wrap::Clamp);
    for filter in [
        Filter::Point,
        Filter::Bilinear,
        Filter::Trilinear,
        Filter::Ewa { max_anisotropy: 8.0 },
    ] {
        assert_eq!(at(&map, 0.375, 0.25, filter), Vec3::new(1.0, 0.0, 1.0), "{filter:?}");
        assert_eq!(at(&map, 0.875, 0.75, filter), Vec3::new(3.0, 1.0, 1.0), "{filter:?}");
    }
}

#[test]
fn bilinear_values_by_hand() {
    let map = ramp(Wrap::Clamp);
    // s = 0.45 is at 1.3 among the columns' centres, t = 0.4 at 0.3 among the rows'.
    assert!((at(&map, 0.45, 0.4, Filter::Bilinear) - Vec3::new(1.3, 0.3, 1.0)).length() < 1e-6);
    assert_eq!(at(&map, 0.45, 0.4, Filter::Point), Vec3::new(1.0, 0.0, 1.0));
}

#[test]
fn edges_wrap_as_told() {
    // Half a texel beyond the left edge: between columns 3 and 0.
    for (wrap, red) in [(Wrap::Repeat, 3.0), (Wrap::Black, 0.0), (Wrap::Clamp, 0.0)] {
        let map = ramp(wrap);
        assert_eq!(at(&map, -0.125, 0.25, Filter::Point).x, red, "{wrap:?}");
        assert_eq!(at(&map, 0.0, 0.25, Filter::Bilinear).x, red / 2.0, "{wrap:?}");
    }
    assert_eq!(at(&ramp(Wrap::Black), 1.125, 0.25, Filter::Point), Vec3::ZERO);
    assert_eq!(at(&ramp(Wrap::Clamp), 7.0, 0.25, Filter::Point).x, 3.0);
    assert_eq!(
        at(&ramp(Wrap::Repeat), 7.125, -0.25, Filter::Point),
        Vec3::new(0.0, 1.0, 1.0)
    );
}

#[test]
fn an_octahedral_map_flips_about_its_edges() {
    let map = map(4, 4, Wrap::OctahedralSphere, |x, y| [x as f32, y as f32, 0.0]);
    let texel = |x, y| map.texel(0, x, y).truncate();
    assert_eq!(texel(-1, 0), Vec2::new(0.0, 3.0));
    assert_eq!(texel(4, 1), Vec2::new(3.0, 2.0));
    assert_eq!(texel(1, -1), Vec2::new(2.0, 0.0));
    assert_eq!(texel(2, 4), Vec2::new(1.0, 3.0));
    // Beyond both edges of a corner: the opposite corner.
    assert_eq!(texel(-1, -1), Vec2::new(3.0, 3.0));
}

#[test]
fn every_level_has_the_mean_of_the_image() {
    for (width, height) in [(8, 8), (7, 5), (13, 1), (1, 6), (33, 20)] {
        let value = |x: usize, y: usize| {
            let hash = (x * 7919 + y * 104_729) % 97;
            [hash as f32, (hash % 5) as f32, 2.0]
        };
        let map = map(width, height, Wrap::Repeat, value);
        let mean = |level: &Level| {
            let count = level.width * level.height;
            let sum: Vec3 = (0..count).map(|i| level.texel(i % level.width, i / level.width)).sum();
            sum / count as f32
        };
        let expected = mean(&map.levels[0]);
        for level in &map.levels {
            let found = mean(level);
            assert!(
                (found - expected).abs().max_element() < 1e-4,
                "{width}x{height}: {found} and {expected}"
            );
        }
        let last = map.levels.last().expect("a level");
        assert_eq!((last.width, last.height), (1, 1));
    }
}

#[test]
fn wide_footprints_see_the_mean() {
    let map = map(16, 16, Wrap::Repeat, |x, y| [((x + y) % 2) as f32; 3]);
    for filter in [
        Filter::Point,
        Filter::Bilinear,
        Filter::Trilinear,
        Filter::Ewa { max_anisotropy: 8.0 },
    ] {
        let value = map.lookup(Vec2::new(0.3, 0.6), Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0), filter);
        assert!((value.x - 0.5).abs() < 1e-6, "{filter:?}: {value}");
    }
}

/// Averaged over the whole image, a filtered one has the mean of the image, for any footprint.
#[test]
fn filters_keep_the_mean() {
    let map = map(16, 16, Wrap::Repeat, |x, y| [(x * 3 + y * y) as f32 % 11.0, 1.0, 0.0]);
    let mean = map.coarsest().x;
    let footprints = [
        (Vec2::new(0.01, 0.0), Vec2::new(0.0, 0.01)),
        (Vec2::new(0.1, 0.05), Vec2::new(-0.02, 0.04)),
        (Vec2::new(0.03, 0.3), Vec2::new(0.05, 0.0)),
    ];
    for filter in [Filter::Bilinear, Filter::Trilinear, Filter::Ewa { max_anisotropy: 4.0 }] {
        for (dst0, dst1) in footprints {
            let n = 128;
            let mut sum = 0.0;
            for i in 0..n * n {
                let st = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
                let value = map.lookup(st, dst0, dst1, filter);
                sum += value.x / (n * n) as f32;
                assert!((value.y - 1.0).abs() < 1e-5 && value.z == 0.0);
            }
            // The Gaussian is normalised at each place by the texels that it finds, so its mean is that of the image but nearly.
            let bound = if matches!(filter, Filter::Ewa { .. }) {
                5e-3
            } else {
                1e-4
            };
            assert!((sum / mean - 1.0).abs() < bound, "{filter:?}: {sum} and {mean}");
        }
    }
}

/// Along stripes a thin ellipse keeps them apart, where a round one would see grey.
#[test]
fn the_ellipse_is_anisotropic() {
    let map = map(64, 64, Wrap::Repeat, |x, _| [((x / 4) % 2) as f32; 3]);
    let (thin, long) = (Vec2::new(0.005, 0.0), Vec2::new(0.0, 0.2));
    let middle = Vec2::new(6.0 / 64.0, 0.5);
    let sharp = map.lookup(middle, thin, long, Filter::Ewa { max_anisotropy: 64.0 });
    let round = map.lookup(middle, thin, long, Filter::Ewa { max_anisotropy: 1.0 });
    let trilinear = map.lookup(middle, thin, long, Filter::Trilinear);
    assert!(sharp.x > 0.99, "{sharp}");
    assert!(
        (round.x - 0.5).abs() < 0.1 && (trilinear.x - 0.5).abs() < 0.1,
        "{round} {trilinear}"
    );
}

#[test]
fn only_the_first_channel_where_a_number_is_wanted() {
    let window = Window::of_size(2, 1);
    let image = Arc::new(Image::rgb(window, window, vec![1.0, 5.0, 9.0, 3.0, 5.0, 9.0]).expect("an image"));
    let map = MipMap::new(&image, Wrap::Clamp, true).expect("colour");
    assert_eq!(map.coarsest(), Vec3::splat(2.0));
    let depth = Image::new(window, window, vec!["Z".into()], vec![0.0; 2]).expect("an image");
    assert!(MipMap::new(&Arc::new(depth), Wrap::Clamp, true).is_none());
}

#[test]
fn what_is_wrapped_is_the_remainder() {
    for size in 1..9 {
        for x in -30..30 {
            assert_eq!(wrapped(x, size), x.rem_euclid(size as i64), "{x} of {size}");
        }
    }
}
