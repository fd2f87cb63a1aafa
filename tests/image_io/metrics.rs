//! Comparison of image files.

use lucerna::Error;
use lucerna::image_io::{Comparison, Image, Window};
use tempfile::tempdir;

use crate::{crop, write};

#[test]
fn comparison_of_files() {
    let directory = tempdir().unwrap();
    let [a, b, small, infinite] = ["a.exr", "b.png", "small.exr", "infinite.exr"].map(|n| directory.path().join(n));
    let constant = |width, height, value| {
        let window = Window::of_size(width, height);
        Image::rgb(window, window, vec![value; window.pixel_count() * 3]).unwrap()
    };
    write(&a, &constant(8, 4, 0.75), None, 0.0);
    write(&b, &constant(8, 4, 1.0), None, 0.0);
    write(&small, &constant(4, 4, 1.0), None, 0.0);
    write(&infinite, &crop(), None, 0.0);
    let comparison = Comparison::of_files(&a, &b).unwrap();
    assert_eq!((comparison.mse, comparison.mean_difference), (0.0625, Some(-0.25)));
    let json = serde_json::to_value(comparison).unwrap();
    let keys: Vec<_> = json.as_object().unwrap().keys().cloned().collect();
    assert_eq!(keys, ["flip", "mean_a", "mean_b", "mean_difference", "mse", "relmse"]);

    let different = Comparison::of_files(&a, &small).unwrap_err();
    assert_eq!((different.exit_code(), matches!(different, Error::Usage(_))), (2, true));
    let not_finite = Comparison::of_files(&infinite, &infinite).unwrap_err().to_string();
    assert!(
        not_finite.contains("infinite.exr") && not_finite.contains("not a finite number"),
        "{not_finite}"
    );
}
