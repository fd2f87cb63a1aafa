//! Cameras that look all around, and those that look through lenses.

use std::path::Path;

use lucerna::desc::{CameraKind, ParseOptions, RealisticDesc, StopShape, load};
use lucerna::error::Error;
use lucerna::sampling::SphereMap;

use crate::scene;

#[test]
fn spherical_cameras_have_a_map() {
    let of = |text: &str| {
        let scene = scene(&format!("Camera \"spherical\" {text} WorldBegin"));
        (scene.views[0].camera.kind.clone(), scene.warnings.len())
    };
    assert_eq!(of(""), (CameraKind::Spherical(SphereMap::EqualArea), 0));
    let lat_long =
        of("\"string mapping\" \"equirectangular\" \"float lensradius\" 1 \"float screenwindow\" [-1 1 -1 1]");
    assert_eq!(lat_long, (CameraKind::Spherical(SphereMap::LatLong), 2));
}

/// A camera with this table of lenses and these parameters; its warnings.
fn lenses(table: &str, parameters: &str) -> Result<(RealisticDesc, Vec<String>), String> {
    let directory = tempfile::tempdir().expect("a directory");
    let write = |name: &str, text: &str| std::fs::write(directory.path().join(name), text).expect("written");
    write("a.lens", table);
    write(
        "a.pbrt",
        &format!("Camera \"realistic\" \"string lensfile\" \"a.lens\" {parameters} WorldBegin"),
    );
    let scene = load(&directory.path().join("a.pbrt"), &ParseOptions::default()).map_err(|e| match e {
        Error::Scene(errors) => errors.iter().map(ToString::to_string).collect::<String>(),
        other => panic!("{other}"),
    })?;
    let CameraKind::Realistic(desc) = &scene.views[0].camera.kind else {
        panic!("a realistic camera")
    };
    let warnings = scene.warnings.iter().map(|w| w.message.clone()).collect();
    Ok((RealisticDesc::clone(desc), warnings))
}

const TABLE: &str = "# radius thickness eta diameter\n 30 5 1.5 20\n0 2 0 8 # the stop\n\n-40 50 1 20\n";

#[test]
fn tables_of_lenses_are_read() {
    let (desc, warnings) = lenses(TABLE, "\"float aperturediameter\" 4 \"float focusdistance\" 3").expect("lenses");
    let rows: Vec<_> = desc
        .surfaces
        .iter()
        .map(|s| [s.radius, s.thickness, s.eta, s.diameter])
        .collect();
    assert_eq!(
        rows,
        [[30.0, 5.0, 1.5, 20.0], [0.0, 2.0, 0.0, 4.0], [-40.0, 50.0, 1.0, 20.0]]
    );
    assert_eq!(
        (desc.focus_distance, desc.shape, warnings.len()),
        (3.0, StopShape::Round, 0)
    );
    // More than there is.
    let (desc, warnings) = lenses(TABLE, "\"float aperturediameter\" 9 \"string aperture\" \"star\"").expect("lenses");
    assert_eq!((desc.surfaces[1].diameter, desc.shape), (8.0, StopShape::Star));
    assert!(warnings[0].contains("8 mm, which is taken"), "{warnings:?}");
}

#[test]
fn bad_tables_are_refused() {
    for (table, message) in [
        ("", "four numbers for each surface"),
        ("30 5 1.5", "this one has 3"),
        ("30 5 1.5 20\n-40 x 1 20", "its line 2 has something"),
        ("30 5 1.5 20\n-40 nan 1 20", "its line 2 has something"),
        ("30 5 1.5 0", "line 1 has an opening that is not positive"),
        ("30 -5 1.5 20", "negative thickness"),
        ("30 5 0.5 20", "index of refraction that is not between"),
        ("0 5 1 20\n0 5 1 20", "line 2 is a second aperture stop"),
    ] {
        let found = lenses(table, "").map(|_| ()).expect_err(table);
        assert!(found.contains(message) && found.contains("a.lens"), "{table}: {found}");
    }
    for parameters in ["\"float focusdistance\" 0", "\"string aperture\" \"hexagon\""] {
        assert!(lenses(TABLE, parameters).is_err(), "{parameters}");
    }
}

/// The table that comes with Lucerna.
#[test]
fn the_triplet_is_a_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lens.pbrt");
    let scene = load(&path, &ParseOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let CameraKind::Realistic(desc) = &scene.views[0].camera.kind else {
        panic!("a realistic camera")
    };
    assert_eq!(desc.surfaces.len(), 7);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}
