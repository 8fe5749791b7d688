use super::*;

fn png(path: &Path) -> Target {
    Target::new(path, PNG)
}

#[track_caller]
fn refused(inputs: &[&Path], outputs: &[Target], message: &str) {
    let error = format!("{:#}", check(inputs, outputs).expect_err("refused"));
    assert!(error.contains(message), "{error}");
}

#[test]
fn one_file_by_two_names_is_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let input = path("in.png");
    fs::write(&input, "in").unwrap();
    refused(&[&input], &[png(&input)], "the same file as the input");
    refused(&[&input], &[png(&folder.path().join("./in.png"))], "the same file as the input");
    fs::hard_link(&input, path("hard.png")).unwrap();
    refused(&[&input], &[png(&path("hard.png"))], "the same file as the input");
    refused(&[], &[png(&path("a.png")), png(&path("A.PNG"))], "the same place as another output");
    refused(&[], &[png(Path::new("-")), Target::new("-", JSON)], "the same place as another output");
    check(&[&input], &[png(&path("a.png")), png(&path("b.png")), png(Path::new("-"))]).unwrap();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("in.png", path("soft.png")).unwrap();
        refused(&[&input], &[png(&path("soft.png"))], "the same file as the input");
        // links to a file that is not there yet
        std::os::unix::fs::symlink("new.png", path("x.png")).unwrap();
        refused(&[], &[png(&path("x.png")), png(&path("new.png"))], "the same place as another output");
        check(&[], &[Target::new("/dev/null", PNG), Target::new("/dev/null", JSON)]).unwrap();
    }
    // nothing is left of what was tried
    let left = fs::read_dir(folder.path())
        .unwrap()
        .filter(|e| e.as_ref().unwrap().file_name().to_string_lossy().starts_with(".selvedge"));
    assert_eq!(left.count(), 0);
}

#[test]
fn places_that_cannot_be_written_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    refused(&[], &[png(&folder.path().join("no/such/a.png"))], "no/such");
    refused(&[], &[png(folder.path())], "a folder");
    refused(&[], &[png(&folder.path().join("a.ppm"))], "a PNG picture, so its name ends in .png");
    refused(&[], &[Target::new(folder.path().join("a.png"), STEP)], ".step or .stp or .p21");
    check(&[], &[png(&folder.path().join("a.PNG")), png(&folder.path().join("plain"))]).unwrap();
}

/// The old file stays until the new one is whole, and keeps its permissions then; links lead where they led.
#[test]
fn a_file_is_whole_or_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    fs::write(&path, "old").unwrap();
    let failed = write(&path, |to| {
        to.write_all(&[7; 1 << 16])?;
        bail!("no more")
    });
    assert!(format!("{:#}", failed.unwrap_err()).contains("no more"));
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        let link = folder.path().join("link.png");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write(&link, |to| Ok(to.write_all(b"new")?)).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(fs::read(&path).unwrap(), b"new");
        // a device stays one, and says when it is full
        let full = write(Path::new("/dev/full"), |to| Ok(to.write_all(b"more")?)).unwrap_err();
        assert!(format!("{full:#}").starts_with("cannot write /dev/full: "), "{full:#}");
    }
}

#[test]
fn words_go_before_the_ending() {
    assert_eq!(with_name(Path::new("a/b.c.png"), "-close"), Path::new("a/b.c-close.png"));
    assert_eq!(with_name(Path::new("plain"), "_iso"), Path::new("plain_iso"));
}
