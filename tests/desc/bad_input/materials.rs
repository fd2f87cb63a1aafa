//! `Material`, `MakeNamedMaterial`, `NamedMaterial`, and the spectra that they take.

use super::{Case, check};

#[test]
fn kinds_and_names() {
    let cases: [Case; 7] = [
        (
            "WorldBegin Material @\"subsurface\"",
            "the material `subsurface` is not supported",
            "",
        ),
        ("WorldBegin Material @\"difuse\"", "unknown material", "`diffuse`"),
        ("WorldBegin MakeNamedMaterial @\"a\"", "no type", ""),
        (
            "WorldBegin MakeNamedMaterial \"a\" \"string type\" @\"difuse\"",
            "unknown material `difuse`",
            "`diffuse`",
        ),
        (
            "WorldBegin MakeNamedMaterial \"Wall\" \"string type\" \"diffuse\"\nNamedMaterial @\"Wal\" Shape \"sphere\"",
            "there is no named material `Wal`",
            "`Wall`",
        ),
        (
            "WorldBegin MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial @\"a\" \"string type\" \"diffuse\"",
            "there is a named material `a` already",
            "",
        ),
        (
            "WorldBegin Material \"conductor\" \"float roughness\" @-1",
            "must be 0 or more",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn spectra() {
    let cases: [Case; 15] = [
        (
            "WorldBegin Material \"dielectric\" \"spectrum eta\" @\"sellmeier-N-BK8\"",
            "neither the name of a spectrum nor a file",
            "`sellmeier-N-BK7`",
        ),
        (
            "WorldBegin Material \"diffuse\" \"rgb reflectance\" [.5 @1.5 .5]",
            "has the value 1.5, it must be between 0 and 1",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" \"rgb reflectance\" @[.5 .5]",
            "takes 3 values, found 2",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" @\"float reflectance\" .5",
            "has the type `float`, expected `rgb` or",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" \"texture reflectance\" @\"wood\"",
            "no spectrum texture `wood`",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" \"spectrum reflectance\" @[400 .5 500]",
            "pairs",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" \"spectrum reflectance\" [400 .5 @400 .5]",
            "must increase",
            "",
        ),
        (
            "WorldBegin Material \"diffuse\" \"spectrum reflectance\" [400 .5 500 @-1]",
            "between 0 and 1",
            "",
        ),
        (
            "WorldBegin Material \"conductor\" \"spectrum eta\" @\"metal-Cu-eat\"",
            "neither the name",
            "`metal-Cu-eta`",
        ),
        (
            "WorldBegin Material \"conductor\" @\"rgb reflectance\" [0 0 0] \"rgb k\" [1 1 1]",
            "either",
            "",
        ),
        (
            "WorldBegin Material \"dielectric\" \"float eta\" @0",
            "must be positive",
            "",
        ),
        (
            "WorldBegin Material \"dielectric\" \"rgb eta\" @[1 1.1 1.2]",
            "not a colour",
            "",
        ),
        (
            "WorldBegin Texture \"wood\" \"spectrum\" \"constant\" Material \"diffuse\" \"texture reflectance\" @\"wod\"",
            "no spectrum texture `wod`",
            "`wood`",
        ),
        (
            "WorldBegin Texture \"a\" \"float\" \"constant\" Material \"diffuse\" \"texture reflectance\" @\"a\"",
            "no spectrum texture `a`",
            "there is a float texture of that name",
        ),
        (
            "WorldBegin Material \"diffuse\" \"texture reflectance\" @[\"a\" \"b\"]",
            "takes 1 value, found 2",
            "",
        ),
    ];
    cases.iter().for_each(check);
}

#[test]
fn materials_of_materials() {
    let cases: [Case; 6] = [
        (
            "WorldBegin MakeNamedMaterial \"g\" \"string type\" \"dielectric\"\nMaterial @\"sided\" \"string back\" \"g\"",
            "cannot contain one that transmits",
            "",
        ),
        (
            "WorldBegin MakeNamedMaterial \"g\" \"string type\" \"thindielectric\"
             MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [ \"g\" \"g\" ]
             Material @\"sided\" \"string front\" \"m\"",
            "cannot contain one that transmits",
            "",
        ),
        (
            "WorldBegin MakeNamedMaterial \"d\" \"string type\" \"diffuse\" Material @\"tinted\" \"string material\" \"d\"",
            "can be `tinted`",
            "",
        ),
        ("WorldBegin Material @\"tinted\"", "names the one that it tints", ""),
        (
            "WorldBegin MakeNamedMaterial \"a\" \"string type\" @\"sided\" \"string front\" \"a\"",
            "contains itself",
            "",
        ),
        (
            "WorldBegin Material \"sided\" \"string front\" @\"nobody\"",
            "no named material `nobody`",
            "",
        ),
    ];
    cases.iter().for_each(check);
}
