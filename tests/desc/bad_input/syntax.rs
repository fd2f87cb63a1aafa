//! What is no pbrt text.

use super::{Case, check};
use crate::errors;

#[test]
fn syntax() {
    let cases: [Case; 20] = [
        (
            "WorldBegin\n @Shappe \"sphere\" \"float radius\" 1",
            "unknown directive `Shappe`",
            "`Shape`",
        ),
        ("WorldBegin @\"sphere\"", "expected a directive", ""),
        ("WorldBegin @] Shape \"sphere\"", "expected a directive, found `]`", ""),
        (
            "WorldBegin Shape @Translate 1 2 3",
            "expected a string in double quotes, found `Translate`",
            "",
        ),
        ("WorldBegin @Shape", "found the end of the file", ""),
        (
            "WorldBegin\n\tTranslate 1 2 @Shape \"sphere\"",
            "expected 3 finite numbers, found `Shape` after 2",
            "",
        ),
        (
            "WorldBegin Translate 1 2 @1e999",
            "expected 3 finite numbers, found `1e999`",
            "",
        ),
        ("WorldBegin Transform @1 2 3", "expected `[`", ""),
        ("WorldBegin Transform [ 1 2 3 @]", "expected 16 finite numbers", ""),
        ("WorldBegin Shape @\"sphere", "not closed", ""),
        ("WorldBegin Shape @\"sph\\qere\"", "unknown escape", ""),
        ("WorldBegin Shape \"sphere\" @\"float radius\"", "no value", ""),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" @[ 1",
            "not closed by `]`",
            "",
        ),
        ("WorldBegin Shape \"sphere\" @\"radius\" 1", "type and its name", ""),
        (
            "WorldBegin Shape \"sphere\" @\"flaot radius\" 1",
            "unknown parameter type `flaot`",
            "`float`",
        ),
        (
            "WorldBegin Shape \"sphere\" @\"point P\" [1 2 3]",
            "unknown parameter type `point`",
            "`point3`",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" 1 @\"float radius\" 2",
            "a second time",
            "",
        ),
        (
            "WorldBegin ActiveTransform @Both",
            "expected `All`, `StartTime` or `EndTime`, found `Both`",
            "",
        ),
        (
            "WorldBegin Shape \"sphere\" \"float radius\" [ 1 @Shape \"sphere\"",
            "expected a finite number, found `Shape`",
            "",
        ),
        ("@WorldBegn", "unknown directive", "`WorldBegin`"),
    ];
    for case in &cases[..19] {
        check(case);
    }
    // Besides, there is no world then.
    let errors = errors("WorldBegn");
    assert_eq!(errors.len(), 2);
    assert!(errors[0].message.contains(cases[19].1) && errors[1].message.contains("before `WorldBegin`"));
}
