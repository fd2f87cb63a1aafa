//! `LightSource`, `AreaLightSource`.

use super::{Case, check};

#[test]
fn lights() {
    let cases: [Case; 8] = [
        (
            "WorldBegin LightSource \"infinite\" \"rgb L\" [1 1 @-1]",
            "0 or more",
            "",
        ),
        ("WorldBegin LightSource \"infinite\" \"blackbody L\" @0", "kelvin", ""),
        (
            "WorldBegin LightSource \"infinite\" \"spectrum L\" @[400 0 500 0]",
            "luminance",
            "",
        ),
        ("WorldBegin LightSource @\"sopt\"", "unknown light `sopt`", "`spot`"),
        (
            "WorldBegin AreaLightSource @\"difuse\"",
            "unknown area light",
            "`diffuse`",
        ),
        (
            "WorldBegin AreaLightSource \"diffuse\" \"string filename\" @\"x\"",
            "cannot read x",
            "",
        ),
        (
            "WorldBegin AreaLightSource \"diffuse\" @\"float L\" 3",
            "has the type `float`",
            "",
        ),
        (
            "WorldBegin LightSource \"distant\" @\"point3 to\" [0 0 0]",
            "must differ",
            "",
        ),
    ];
    cases.iter().for_each(check);
}
