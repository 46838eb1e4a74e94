//! The texts that are scenes, and the errors of those that are not.

use saltus_scene::{Contact, Scene};

fn message(toml: &str) -> String {
    match Scene::parse("s.toml", toml.as_bytes()) {
        Ok(_) => format!("accepted: {toml}"),
        Err(error) => {
            assert!(error.line() >= 1 && error.line() <= toml.split('\n').count(), "{error}");
            error.to_string()
        }
    }
}

const DROP: &str = "restitution = 0.8\n[ball]\nheight = \"1 m\"\n";

/// Each refusal names the place and says what to do.
#[test]
fn scenes_that_are_refused() {
    for (toml, parts) in [
        ("", &["s.toml:1:1", "empty"][..]),
        ("# nothing\n", &["s.toml:1:1", "no ball"]),
        ("restitution = 0.8\nball = []\n", &["2:8", "no ball"]),
        (
            "restitution = 0.8\n[ball]\nheigth = \"1 m\"\n",
            &["3:1", "`heigth` is no key here", "did you mean `height`?", "^^^^^^"],
        ),
        ("restitution = 0.8\n[ball]\nheight = \"1 m\"\ngravity = \"moon\"\n", &["4:1", "at the top of the file"]),
        ("restitution = 0.8\nheight = \"1 m\"\n[ball]\n", &["2:1", "`height` belongs under [ball] or under [floor]"]),
        (
            "restitution = 0.8\n[ball]\nheight = \"1 s\"\n",
            &["3:10", "'s' in '1 s' is not a unit of length but of time", "use one of m"],
        ),
        ("restitution = 0.8\n[ball]\nheight = \"100\"\n", &["3:10", "'100' has no unit", "'100 m'"]),
        ("restitution = 0.8\n[ball]\nheight = 1 m\n", &["3:", "in quotes"]),
        ("restitution = 0,8\n[ball]\nheight = 1\n", &["1:", "decimal point"]),
        ("restitution = \"0.8\"\n[ball]\nheight = 1\n", &["1:15", "\"0.8\" does not belong here", "a number"]),
        ("restitution = 1.2\n[ball]\nheight = 1\n", &["1:15", "1.2 is not a coefficient of restitution"]),
        ("restitution = nan\n[ball]\nheight = 1\n", &["1:15", "NaN is not a finite number"]),
        ("restitution = [0.8, 0.7]\n[ball]\nheight = 1\n", &["1:15", "upside down"]),
        ("restitution = [0.8]\n[ball]\nheight = 1\n", &["1:15", "two ends"]),
        (
            "restitution = { law = \"liner\" }\n[ball]\nheight = 1\n",
            &["1:23", "\"liner\" is not known", "did you mean \"linear\""],
        ),
        (
            "restitution = { law = \"linear\", cor = 0.9, slope = 0.1, fastest = 5 }\n[ball]\nheight = 1\n",
            &["1:", "1.4 is not a coefficient"],
        ),
        (
            "restitution = { law = \"plastic\", knots = [] }\n[ball]\nheight = 1\n",
            &["1:", "`knots` does not belong to law = \"plastic\""],
        ),
        (
            "restitution = { law = \"knots\", knots = [[2, 0.8], [1, 0.9]] }\n[ball]\nheight = 1\n",
            &["1:", "knot 2", "sort"],
        ),
        ("[ball]\nheight = 1\n", &["no restitution is given"]),
        (
            "[ball]\nmaterial = \"tenis ball\"\nheight = 1\n[floor]\nmaterial = \"granit\"\n",
            &["2:12", "'tenis ball' on 'granit'", "'tennis ball on granite'"],
        ),
        ("restitution = 0.8\n[ball]\nheight = \"-1 cm\"\n", &["3:10", "below the floor", "-0.01 m"]),
        ("restitution = 0.8\n[ball]\nheight = inf\n", &["3:10", "inf is not a finite number"]),
        ("restitution = 0.8\n[ball]\nheight = \"NaN m\"\n", &["3:10", "not a length"]),
        ("restitution = 0.8\n[ball]\nheight = 1979-05-27\n", &["3:10", "a date"]),
        ("restitution = 0.8\n[ball]\nheight = true\n", &["3:10", "true does not belong here", "a length"]),
        (
            "restitution = 0.8\n[ball]\nmass = \"-45 g\"\nheight = 1\n",
            &["3:8", "-0.045 is not a mass in kg", "above zero"],
        ),
        (
            "restitution = 0.8\n[ball]\nradius = 0.1\ndiameter = 0.2\nheight = 1\n",
            &["4:12", "both `radius` and `diameter`"],
        ),
        ("restitution = 0.8\n[ball]\nradius = 0.1\n", &["no place to start"]),
        (
            "restitution = 0.8\n[ball]\nheight = 1\nradius = 0.1\nspin = \"2 rev/s\"\n",
            &["5:8", "no direction in a vertical scene"],
        ),
        (
            "restitution = 0.8\n[ball]\nheight = 1\nvelocity = [1, 0]\nspin = \"2 rev/s\"\n[run]\nuntil = 1\n",
            &["5:8", "a point cannot spin"],
        ),
        (
            "restitution = 0.8\n[ball]\nposition = [0, 1]\nvelocity = [1, 0, 0]\n",
            &["4:12", "`velocity` has 3 components, `position` has 2"],
        ),
        ("restitution = 0.8\n[ball]\nposition = [\"0 m\", \"1 kg\"]\n", &["3:20", "not a unit of length but of mass"]),
        ("restitution = 1\n[ball]\nheight = 1\n", &["nothing ends this run", "loses nothing", "until"]),
        ("gravity = 0\nrestitution = 0.5\n[ball]\nheight = 1\n", &["nothing ends this run", "no gravity"]),
        (
            "gravity = -9.81\nrestitution = 0.5\n[ball]\nheight = 1\n",
            &["1:11", "-9.81 is not a gravity", "leave the minus out"],
        ),
        (
            "gravity = \"mon\"\nrestitution = 0.5\n[ball]\nheight = 1\n",
            &["1:11", "no body named 'mon'", "did you mean 'moon'?"],
        ),
        (
            "gravity = \"9.81 m/s\"\nrestitution = 0.5\n[ball]\nheight = 1\n",
            &["1:11", "not a unit of acceleration but of speed"],
        ),
        (
            "restitution = 0.8\ndrag = { per_length = 0.1, coefficient = 0.5 }\n[ball]\nheight = 1\n",
            &["2:", "given twice"],
        ),
        ("restitution = 0.8\ndrag = { coefficient = 0.5 }\n[ball]\nheight = 1\n", &["2:", "needs the radius"]),
        ("restitution = 0.8\n[drag]\n[ball]\nheight = 1\n", &["2:1", "drag is named but not given"]),
        ("restitution = 0.8\nair = { wind = 3 }\n[ball]\nheight = 1\n", &["2:", "acts on nothing"]),
        ("restitution = 0.8\n[magnus]\n[ball]\nheight = 1\nradius = 0.1\nmass = 1\n", &["2:1", "no ball spins"]),
        ("restitution = 0.8\n[ball]\nheight = 1\n[floor]\nkind = \"incline\"\n", &["5:8", "no angle"]),
        (
            "restitution = 0.8\n[ball]\nheight = 1\n[floor]\nangle = \"30 deg\"\n",
            &["5:9", "`angle` does not belong to a level floor"],
        ),
        (
            "restitution = 0.8\n[ball]\nposition = [0, 0]\nradius = 0.1\n[floor]\nkind = \"incline\"\nangle = \"30 deg\"\n",
            &["3:12", "inside the incline"],
        ),
        (
            "restitution = 0.8\n[ball]\nheight = 0\n[floor]\nmotion = { amplitude = 0.1, frequency = 2, phase = \"90 deg\" }\n",
            &["3:10", "below the floor", "0.1 m"],
        ),
        (
            "restitution = 0.8\n[ball]\nheight = 0\n[floor]\nmotion = { schedule = [[1, 0], [1, 0]] }\n",
            &["5:", "sort its points by time"],
        ),
        (
            "restitution = 0.8\n[contact]\nlaw = \"hertz\"\nstiffness = 1e9\n[ball]\nheight = 1\nmass = 1\n",
            &["1:15", "comes of the contact's force"],
        ),
        (
            "[contact]\nlaw = \"hertz\"\nstiffness = \"1e9 N/m\"\n[ball]\nheight = 1\nmass = 1\n",
            &["3:13", "not a unit of Hertz stiffness but of stiffness"],
        ),
        ("[contact]\nlaw = \"hertz\"\n[ball]\nheight = 1\nmass = 1\n", &["2:7", "not determined"]),
        ("[contact]\nlaw = \"kelvin-voigt\"\nstiffness = 1000\n[ball]\nheight = 1\n", &["2:7", "needs the mass"]),
        ("[contact]\nstiffness = 1000\n[ball]\nheight = 1\n", &["1:1", "`law` is missing"]),
        (
            "restitution = 1\n[[ball]]\nheight = 0\nradius = 0.1\nmass = 1\n[[ball]]\nheight = 0.1\nradius = 0.1\nmass = 1\n[run]\nuntil=1\n",
            &["7:10", "ball 2 starts inside ball 1"],
        ),
        ("restitution = 0.8\n[ball]\nheight = 1\n[ball]\nheight = 2\n", &["4:", "given twice", "[[ball]]"]),
        ("restitution = 0.8\n[ball]\nheight = 1\n[run]\nmost_jumps = -1\n", &["5:14", "a whole number"]),
        ("restitution = 0.8\n[ball]\nheight = 1\n[run]\ntolerance = 0\n", &["5:13", "0 is not a relative tolerance"]),
        ("restitution = 0.8\nball = 3\n", &["2:8", "does not belong here", "such as { height = \"1 m\" }"]),
        ("restitution = 0.8\ncollisions = 0.9\nball = { height = 1 }\n", &["2:14", "such as { restitution = 0.85 }"]),
        (
            "restitution = 1\nball = { position = [0, 1] }\nfloor = { kind = 'box', size = 1 }\n",
            &["3:32", "size = [\"1 m\", \"1 m\"]"],
        ),
        ("restitution = 0.8\n[ball\n", &["2:"]),
        ("height 1\n", &["1:", "key = value"]),
    ] {
        let message = message(toml);
        if std::env::var_os("SHOW").is_some() {
            println!("{message}\n");
        }
        for part in parts {
            assert!(message.contains(part), "no '{part}' in:\n{message}\nof:\n{toml}");
        }
    }
}

#[test]
fn bytes_that_are_no_text() {
    let fail = |bytes: &[u8]| Scene::parse("s.toml", bytes).unwrap_err();
    let utf8 = fail(b"restitution = 0.8\n# caf\xe9\n");
    assert_eq!((utf8.line(), utf8.column()), (2, 6));
    assert!(utf8.message().contains("not UTF-8"));
    assert!(fail(b"\xff\xfea\0b\0").message().contains("UTF-16"));
    assert!(fail(&vec![b'x'; 10_000_000]).message().contains("larger than 1 MiB"));
    assert!(fail("[".repeat(Scene::LARGEST).as_bytes()).to_string().len() < 1000);
    assert!(fail(format!("a = {}", "[".repeat(100_000)).as_bytes()).to_string().len() < 1000);
    assert!(fail(&[0; 4096]).line() == 1);
}

#[test]
fn a_mark_and_windows_line_ends_change_nothing() {
    let plain = Scene::parse("s.toml", DROP.as_bytes()).unwrap();
    let marked = format!("\u{feff}{}", DROP.replace('\n', "\r\n"));
    assert_eq!(Scene::parse("s.toml", marked.as_bytes()), Ok(plain));
    let wrong = marked.replace("1 m", "1 s");
    let error = Scene::parse("s.toml", wrong.as_bytes()).unwrap_err();
    assert_eq!((error.line(), error.column()), (3, 10));
    assert!(!error.to_string().contains('\r'));
}

#[test]
fn what_no_model_can_do_is_said_where_it_stands() {
    let two = "[[ball]]\nheight = 1\nradius = 0.1\nmass = 1\n[[ball]]\nheight = 2\nradius = 0.1\nmass = 1\n";
    let cases = [
        (format!("collisions = {{ restitution = 0.9 }}\n[contact]\nlaw = 'hertz'\nstiffness = 1e8\n[run]\nuntil = 1\n{two}"), (2, 2)),
        (
            "[run]\nuntil = 1\n[[floor]]\nrestitution = 0.9\n[[floor]]\nkind = 'sine'\namplitude = 0.05\nwavelength = 0.2\n\
             restitution = 0.6\n[ball]\nheight = 0.3\nradius = 0.03\n"
                .to_owned(),
            (5, 1),
        ),
    ];
    for (toml, place) in cases {
        let error = Scene::parse("s.toml", toml.as_bytes()).unwrap().plan().unwrap_err();
        let found = error.in_text().unwrap();
        assert_eq!((found.line(), found.column()), place, "{error}");
        assert!(error.to_string().contains("\n  help: "), "{error}");
    }
    // A scene changed by hand is no longer what stands in the text, but still says where that key
    // is.
    let mut scene = Scene::parse("s.toml", format!("restitution = 0.8\n[run]\nuntil = 1\n{two}").as_bytes()).unwrap();
    scene.contact = Contact::Hertz(saltus_bounce::contact::Hertz::new(1e8).unwrap());
    let error = scene.plan().unwrap_err();
    assert!(error.in_text().is_none() && error.to_string().starts_with("[contact]: "), "{error}");
}

/// However long the words of a file, a sentence about them is short, and has what is wrong.
#[test]
fn long_words_are_quoted_in_part() {
    let long = "ü".repeat(100_000);
    for toml in [
        format!("{long} = 1\n"),
        format!("\"{long}\" = 1\n"),
        format!("restitution = \"{long}\"\n"),
        format!("ball = {{ height = \"{long}\" }}\n"),
        format!("ball = {{ material = \"{long}\", height = 1 }}\n"),
        format!("floor = {{ kind = \"{long}\" }}\nball = {{ height = 1 }}\n"),
    ] {
        let says = message(&toml);
        assert!(says.len() < 4_000 && !says.starts_with("accepted"), "{} bytes: {says:.300}", says.len());
    }
    assert!(message(&format!("\"{long}\" = 1\n")).contains("is no key here"));
}

/// Numbers with which nothing can be right are refused where they stand, with the range.
#[test]
fn quantities_have_ranges() {
    for (toml, says) in [
        (
            "restitution = 0.5\nball = { height = 1, velocity = '1e160 m/s' }\n",
            "'1e160 m/s' is beyond the numbers that can be right",
        ),
        ("restitution = 0.5\nball = { height = 1, velocity = -1e160 }\n", "a speed is at most 299792458 m/s"),
        ("restitution = 1\nball = { height = 1 }\nrun = { until = '1e300 s' }\n", "a time is at most 1e12 s"),
        ("restitution = 0.5\nball = { height = '1e200 km' }\n", "a length is at most 1e12 m"),
        (
            "restitution = 0.5\nball = { height = 1 }\nrun = { until = 1 }
            floor = { motion = { amplitude = '1 mm', frequency = '1e12 Hz' } }\n",
            "the floor moves at 6.3e9 m/s",
        ),
        (
            "restitution = 0.5\nball = { height = 1 }\nrun = { until = 1 }
            floor = { motion = { schedule = [[0, 0], ['1 us', '-1 km']] } }\n",
            "a motion of 299792458 m/s at most",
        ),
        ("gravity = 1e31\nrestitution = 0.5\nball = { height = 1 }\n", "an acceleration is at most"),
        ("gravity = '1e31 m/s^2'\nrestitution = 0.5\nball = { height = 1 }\n", "an acceleration is at most"),
        ("restitution = 0.5\nball = { height = 1, radius = 1e-200 }\n", "1e-200 is too small for a radius in m"),
        (
            "contact = { law = 'hertz', stiffness = 1e300 }\nball = { height = 1, mass = 1 }\nrun = { until = 1 }\n",
            "at most",
        ),
    ] {
        let message = message(toml);
        assert!(message.contains(says) && !message.starts_with("accepted"), "{toml}: {message}");
    }
    // The ends themselves run, and end.
    for toml in [
        "restitution = 1\nball = { height = 1 }\nrun = { until = '1e12 s' }\n",
        "restitution = 0.5\nball = { height = '1e12 m', velocity = 299792458 }\n",
    ] {
        let record = Scene::parse("s.toml", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap();
        assert!(record.impacts().len() > 20);
    }
}
