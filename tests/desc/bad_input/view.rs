//! `Camera`, `Film`, `PixelFilter`.

use super::{Case, check};

#[test]
fn cameras() {
    let cases: [Case; 11] = [
        (
            "Camera \"perspective\" \"float fov\" @[ 180 ] WorldBegin",
            "it must be more than 0 and less than 180 degrees",
            "",
        ),
        (
            "Camera \"perspective\" @\"float shutterclose\" 0 WorldBegin",
            "shutter closes at 0",
            "",
        ),
        (
            "Camera \"perspective\" \"string name\" @\"a/b\" WorldBegin",
            "the name of a view",
            "",
        ),
        (
            "Camera \"perspective\" \"float screenwindow\" @[1 2 3] WorldBegin",
            "takes 4 values, found 3",
            "",
        ),
        (
            "Camera \"perspective\" \"integer blades\" @2 WorldBegin",
            "`blades` is 2, it must be between 3 and 64, or 0",
            "",
        ),
        (
            "Camera \"perspective\" @\"integer bladerotation\" 10 WorldBegin",
            "expected `float`",
            "",
        ),
        ("Camera @\"spheric\" WorldBegin", "unknown camera", "`spherical`"),
        (
            "Camera \"spherical\" \"string mapping\" @\"latlong\" WorldBegin",
            "`equalarea` or `equirectangular`, not `latlong`",
            "",
        ),
        ("Camera @\"realistic\" WorldBegin", "no table of lenses", ""),
        (
            "Camera \"realistic\" \"string lensfile\" @\"nowhere.lens\" WorldBegin",
            "cannot be read",
            "",
        ),
        (
            "Camera \"perspective\" \"string name\" \"a\"\nCamera \"perspective\" \"string name\" @\"a\" WorldBegin",
            "a view `a`",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn films_and_filters() {
    let cases: [Case; 14] = [
        (
            "Film \"rgb\" \"integer xresolution\" @0 WorldBegin",
            "between 1 and",
            "",
        ),
        (
            "Film \"rgb\" \"integer xresolution\" @99999999999 WorldBegin",
            "32 bits",
            "",
        ),
        (
            "Film \"rgb\" \"integer xresolution\" @1.5 WorldBegin",
            "expected an integer, found `1.5`",
            "",
        ),
        (
            "Film \"rgb\" \"bool savefp16\" @\"true\" WorldBegin",
            "expected `true` or `false`",
            "",
        ),
        (
            "Film \"rgb\" @\"float cropwindow\" [.5 .5 0 1] WorldBegin",
            "leaves no pixel",
            "",
        ),
        (
            "Film \"rgb\" \"float maxcomponentvalue\" @0 WorldBegin",
            "`maxcomponentvalue` is 0, it must be positive",
            "",
        ),
        (
            "Film \"rgb\" \"float whitebalance\" @12 WorldBegin",
            "must be a temperature between 1000 and 1000000 K, or 0",
            "",
        ),
        (
            "Film \"rgb\" \"string sensor\" @\"nikon_d800\" WorldBegin",
            "neither the name of a sensor nor a file",
            "`nikon_d810`",
        ),
        (
            "Film \"rgb\" \"string measure\" @\"flux\" WorldBegin",
            "`radiance` or `irradiance`, not `flux`",
            "",
        ),
        ("Film @\"gbufer\" WorldBegin", "unknown film", "`gbuffer`"),
        (
            "Film \"gbuffer\" \"string coordinatesystem\" @\"wolrd\" WorldBegin",
            "`camera` or `world`, not `wolrd`",
            "`world`",
        ),
        (
            "Film \"spectral\" \"integer nbuckets\" @0 WorldBegin",
            "between 1 and 1024",
            "",
        ),
        (
            "Film \"spectral\" @\"float lambdamax\" 360 WorldBegin",
            "more than `lambdamin`",
            "",
        ),
        ("PixelFilter @\"gausian\" WorldBegin", "unknown filter", "`gaussian`"),
    ];
    cases.iter().for_each(check);
}
