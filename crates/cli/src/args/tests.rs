use super::*;
use selvedge_jobs::Image;

#[test]
fn clap_accepts_the_definition() {
    use clap::CommandFactory;
    Cli::command().debug_assert();
}

#[test]
fn sizes() {
    assert_eq!("640x480".parse(), Ok(Size(640, 480)));
    for bad in ["640", "640x", "0x480", "640x480x2", "16385x1", "-1x1"] {
        assert!(bad.parse::<Size>().is_err(), "{bad}");
    }
}

#[test]
fn images() {
    assert_eq!("uv=a=b.npy".parse(), Ok(Aov { image: Image::Uv, file: "a=b.npy".into() }));
    for bad in ["uv", "uv=", "colour=a.npy"] {
        assert!(bad.parse::<Aov>().is_err(), "{bad}");
    }
}

#[test]
fn a_negative_eye_is_not_an_option() {
    let cli = Cli::try_parse_from(["selvedge", "render", "m.step", "-o", "a.png", "--eye", "-1,-2,-3"]);
    let Command::Render(args) = cli.expect("parses").command else { panic!("render") };
    assert_eq!(args.camera.eye, Some(DVec3::new(-1.0, -2.0, -3.0)));
}

#[test]
fn a_budget_is_a_number_of_mebibytes() {
    let parse = |text| Cli::try_parse_from(["selvedge", "render", "m.csg", "-o", "a.png", "--solid-budget", text]);
    let Command::Render(args) = parse("0.5").expect("parses").command else { panic!("render") };
    assert_eq!(args.frame.solid_budget, Some(0.5));
    for bad in ["0", "-1", "nan", "many"] {
        assert!(parse(bad).is_err(), "{bad}");
    }
}
