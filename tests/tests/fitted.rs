//! From readings to a scene: what is fitted, written as a scene and run again, moves as the
//! readings did.

use std::fmt::Write;

use saltus_fit::{CorModel, Fit, ReadOptions, Report, Table};
use saltus_scene::plan::Record;
use saltus_scene::{Law, Scene};

fn run(toml: &str) -> Record {
    Scene::parse("scene", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap()
}

fn read(name: &str, text: &str) -> Table {
    Table::parse(name, text.as_bytes(), &ReadOptions::default()).unwrap()
}

/// The fitted scene.
fn scene(report: &Report) -> (String, Scene) {
    let toml = report.scene().unwrap();
    let scene = Scene::parse("fitted", toml.as_bytes()).unwrap();
    (toml, scene)
}

fn impacts(record: &Record) -> Vec<f64> {
    record.impacts().iter().map(|impact| impact.t).collect()
}

/// The table of a run's contacts, in s, to a microsecond.
fn contacts(record: &Record, count: usize) -> String {
    let mut table = "bounce,time_s\n".to_owned();
    for (n, t) in impacts(record).iter().take(count).enumerate() {
        writeln!(table, "{},{t:.6}", n + 1).unwrap();
    }
    table
}

#[test]
fn heights_and_times_come_back() {
    let truth = run("gravity = 9.81\nrestitution = 0.8\nball = { height = \"2 m\" }\n");
    let mut table = "event,time_s,height_m\nrelease,0,2\n".to_owned();
    let tops: Vec<f64> = truth.apexes(0).iter().map(|top| top.height).collect();
    for (n, t) in impacts(&truth).iter().take(6).enumerate() {
        writeln!(table, "contact,{t:.6},0\napex,,{:.6}", tops[n]).unwrap();
    }
    let report = Fit::new().ball(0.04).run(&read("drop two metres.csv", &table)).unwrap();
    let (toml, fitted) = scene(&report);
    assert!(toml.contains("title = \"Drop two metres\"") && toml.contains("diameter = \"0.04 m\""), "{toml}");
    assert!((fitted.balls[0].lowest().z - 2.0).abs() < 1e-4, "{toml}");
    for (a, b) in impacts(&run(&toml)).iter().zip(impacts(&truth)).take(8) {
        assert!((a - b).abs() < 1e-4, "{a} is not {b}\n{toml}");
    }
}

#[test]
fn a_ball_heard_but_not_seen_starts_at_its_first_contact() {
    let truth = run("gravity = 9.81\nrestitution = 0.7\nball = { height = \"1 m\" }\n");
    let report = Fit::new().sigma_time(1e-5).run(&read("clicks", &contacts(&truth, 7))).unwrap();
    let (toml, fitted) = scene(&report);
    assert_eq!(fitted.balls[0].lowest().z, 0.0);
    let truth = impacts(&truth);
    for (a, b) in impacts(&run(&toml)).iter().zip(truth.iter().skip(1)).take(6) {
        assert!((a - (b - truth[0])).abs() < 1e-4, "{a} is not {b} - {}\n{toml}", truth[0]);
    }
}

#[test]
fn a_cor_that_depends_on_speed_is_written_as_its_law() {
    let law = "restitution = { law = \"linear\", cor = 0.9, slope = \"-0.02 s/m\", fastest = \"20 m/s\" }";
    let truth = run(&format!("gravity = 9.81\n{law}\nball = {{ height = \"3 m\" }}\n"));
    let fit = Fit::new().sigma_time(1e-5).model(CorModel::Linear);
    let report = fit.run(&read("clicks", &contacts(&truth, 12))).unwrap();
    assert_eq!(report.models().iter().find(|model| model.chosen).map(|model| model.name), Some(CorModel::Linear));
    let (toml, fitted) = scene(&report);
    let found = fitted.law(0, 0).unwrap();
    assert!(matches!(found, Law::Knots(_)), "{toml}");
    let truth = impacts(&truth);
    for (a, b) in impacts(&run(&toml)).iter().zip(truth.iter().skip(1)).take(11) {
        assert!((a - (b - truth[0])).abs() < 2e-4, "{a} is not {b} - {}\n{toml}", truth[0]);
    }
}

#[test]
fn a_film_with_drag_is_played_again_at_its_scale() {
    let toml =
        "gravity = 9.81\nrestitution = 0.85\ndrag = { per_length = \"0.12 1/m\" }\nball = { height = \"2 m\" }\n";
    let truth = run(toml);
    for (name, unit, pixels) in [("metres", "height_m", 1.0), ("pixels", "height_px", 400.0)] {
        let mut table = format!("time_s,{unit}\n");
        for k in 0..300 {
            let t = f64::from(k) / 100.0;
            // A little rounding is all the noise there is.
            writeln!(table, "{t},{:.4}", pixels * truth.at(0, t).unwrap().height()).unwrap();
        }
        let report = Fit::new().run(&read(name, &table)).unwrap();
        let (toml, fitted) = scene(&report);
        assert_eq!(toml.contains("scale of the recording is not known"), name == "pixels", "{toml}");
        let again = fitted.plan().unwrap().run().unwrap();
        // It starts where the fit begins, some samples after the ball was let go.
        let late = impacts(&truth)[0] - impacts(&again)[0];
        assert!((0.0..0.1).contains(&late), "{late}");
        for k in 0..200 {
            let t = f64::from(k) / 100.0;
            let (a, b) = (again.at(0, t).unwrap().height(), truth.at(0, t + late).unwrap().height());
            assert!((a - b).abs() < 5e-3, "{name} at {t}: {a} is not {b}\n{toml}");
        }
    }
}

#[test]
fn names_are_no_danger_to_the_scene() {
    let report = Fit::new().run(&Table::from_heights(&[1.0, 0.64, 0.41, 0.26]).unwrap()).unwrap();
    assert!(report.scene().is_some());
    let hostile = "a \"quoted\\\" name\n[run]\nuntil = 1.csv";
    let report = Fit::new().run(&read(hostile, "bounce,height_cm\n0,100\n1,64\n2,41\n3,26\n")).unwrap();
    let (toml, fitted) = scene(&report);
    assert_eq!(fitted.run.until, None, "{toml}");
    assert!(fitted.picture.title.unwrap().contains("\"quoted\\\" name"), "{toml}");
}

#[test]
fn what_is_refused_is_no_scene() {
    let report = Fit::new().run(&Table::from_heights(&[1.0]).unwrap()).unwrap();
    assert_eq!(report.scene(), None);
}
