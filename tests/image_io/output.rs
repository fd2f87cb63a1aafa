//! Targets: checked before, replaced whole after.

use lucerna::Error;
use lucerna::image_io::{Image, PendingOutput, Window, read};
use std::fs;
use std::path::PathBuf;
use tempfile::tempdir;

use crate::{bits, crop, names_in, write};

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_render() {
    let directory = tempdir().unwrap();
    for name in ["a.jpg", "a", "exr", ".png", "a.exr.gz"] {
        let Err(Error::Usage(message)) = PendingOutput::create(&directory.path().join(name)) else {
            panic!("{name} must be refused");
        };
        assert!(message.contains(".exr") && message.contains(".png"), "{message}");
    }
    fs::create_dir(directory.path().join("directory.exr")).unwrap();
    fs::write(directory.path().join("file"), "").unwrap();
    // Nobody can create files in /proc, root included.
    for path in ["missing/a.exr", "directory.exr", "file/a.png", "/proc/a.exr"] {
        let refused = PendingOutput::create(&directory.path().join(path));
        assert!(
            matches!(refused, Err(Error::Io { action: "create", .. })),
            "{path}: {refused:?}"
        );
    }
    assert_eq!(names_in(directory.path()), ["directory.exr", "file"]);
}

#[test]
fn a_target_stays_until_it_is_replaced_whole() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.png");
    fs::write(&path, "old").unwrap();
    let pending = PendingOutput::create(&path).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names_in(directory.path()), ["a.png"]);
    drop(pending);
    assert_eq!(names_in(directory.path()), ["a.png"]);

    // An image that PNG cannot hold is found when it is encoded: the old file survives that.
    let window = Window::of_size(1, 1);
    let depth = Image::new(window, window, vec!["Z".to_owned()], vec![1.0]).unwrap();
    let failed = PendingOutput::create(&path).unwrap().commit(&depth, None, 0.0);
    assert!(matches!(failed, Err(Error::Image { .. })));
    assert_eq!(fs::read(&path).unwrap(), b"old");

    write(&path, &crop(), None, 0.0);
    assert_eq!(read(&path).unwrap().width(), 37);
    assert_eq!(names_in(directory.path()), ["a.png"]);
}

#[cfg(unix)]
#[test]
fn written_files_have_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let directory = tempdir().unwrap();
    let mode = |path: &PathBuf| fs::metadata(path).unwrap().permissions().mode();
    let (ours, other) = (directory.path().join("a.exr"), directory.path().join("other"));
    write(&ours, &crop(), None, 0.0);
    fs::write(&other, "").unwrap();
    assert_eq!(mode(&ours), mode(&other));
}

#[cfg(unix)]
#[test]
fn a_link_is_followed() {
    let directory = tempdir().unwrap();
    let inner = directory.path().join("inner");
    fs::create_dir(&inner).unwrap();
    fs::write(inner.join("real.exr"), "old").unwrap();
    let link = directory.path().join("link.exr");
    std::os::unix::fs::symlink("inner/real.exr", &link).unwrap();
    write(&link, &crop(), None, 0.0);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(bits(&read(&inner.join("real.exr")).unwrap()), bits(&crop()));
    assert_eq!(names_in(&inner), ["real.exr"]);
}
