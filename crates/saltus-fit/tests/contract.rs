//! The JSON that programs rely on.

use saltus_fit::{Fit, ReadOptions, Table};
use serde_json::Value;

const STUDY: &str = "# frame rate: 30\n# gravity: 9.8 m/s^2\nevent,time_s,height_cm\nrelease,0,100\ncontact,0.45,\n\
                     apex,,30\ncontact,0.85,\napex,,10\ncontact,1.11,\n";

fn json(table: &Table, fit: Fit) -> Value {
    serde_json::to_value(fit.run(table).unwrap()).unwrap()
}

fn study() -> Value {
    json(&Table::parse("squash.csv", STUDY.as_bytes(), &ReadOptions::default()).unwrap(), Fit::new())
}

#[test]
fn the_promised_fields_are_there() {
    let report = study();
    assert_eq!(report["schema"], 1);
    assert_eq!(report["table"], "squash.csv");
    assert_eq!(report["verdict"], "doubtful");
    for field in ["value", "standard_error", "low", "high"] {
        assert!(report["cor"][field].is_number(), "{field}");
    }
    for estimate in report["estimates"].as_array().unwrap() {
        assert!(estimate["method"].is_string());
        for field in ["value", "standard_error", "low", "high", "chi_square", "degrees_of_freedom", "p"] {
            assert!(estimate[field].is_number() || estimate[field].is_null(), "{field}");
            assert!(estimate.as_object().unwrap().contains_key(field), "{field}");
        }
    }
    let methods: Vec<&str> =
        report["estimates"].as_array().unwrap().iter().map(|e| e["method"].as_str().unwrap()).collect();
    assert_eq!(methods, ["heights", "heights-mean", "times", "first-flight", "times-mean", "joint"]);
    for list in ["warnings", "repairs", "notes", "hypotheses", "bounces"] {
        assert!(report[list].is_array(), "{list}");
    }
    assert_eq!(report["gravity"]["source"], "table");
    assert_eq!(report["sigma_height"]["source"], "assumed");
    assert_eq!(report["sigma_time"]["source"], "frame rate");
    for field in ["chi_square", "degrees_of_freedom", "p", "largest_conflict_s", "largest_conflict_frames"] {
        assert!(report["agreement"][field].is_number(), "{field}");
    }
    for field in ["name", "cor", "offset_m", "chi_square", "degrees_of_freedom", "p", "settle"] {
        assert!(report["hypotheses"][0].as_object().unwrap().contains_key(field), "{field}");
    }
}

#[test]
fn where_numbers_come_from_is_one_of_five_words() {
    let heights = Table::from_heights(&[1.0, 0.642, 0.408, 0.263, 0.167, 0.108]).unwrap();
    assert_eq!(json(&heights, Fit::new())["sigma_height"]["source"], "scatter");
    assert_eq!(json(&heights, Fit::new().sigma_height(0.002))["sigma_height"]["source"], "stated");
    assert_eq!(json(&heights, Fit::new())["gravity"]["source"], "assumed");
    let scatter = json(&heights, Fit::new());
    assert!(scatter["estimates"][0]["p"].is_null() && scatter["estimates"][0]["chi_square"].is_null());
    assert!(scatter["sigma_time"].is_null() && scatter["agreement"].is_null());
}

#[test]
fn a_refused_table_has_no_cor() {
    let report = json(&Table::from_heights(&[1.0]).unwrap(), Fit::new());
    assert_eq!(report["verdict"], "refused");
    assert!(report["cor"].is_null());
    assert_eq!(report["estimates"].as_array().map(Vec::len), Some(0));
    assert!(report["reason"].as_str().is_some_and(|r| !r.is_empty()));
}

#[test]
fn options_out_of_range_are_errors_that_name_themselves() {
    let table = Table::from_heights(&[1.0, 0.5]).unwrap();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for (fit, name) in [
            (Fit::new().sigma_height(bad), "the standard error of heights"),
            (Fit::new().sigma_time(bad), "the standard error of times"),
            (Fit::new().gravity(bad), "gravity"),
        ] {
            let message = fit.run(&table).unwrap_err().to_string();
            assert!(message.starts_with(name) && message.contains("positive"), "{message}");
        }
    }
}

#[test]
fn a_profile_is_the_cost_with_the_cor_held() {
    // Heights in logarithms, by hand: with e held, ln h0 is the weighted mean of ln h_n - 2 n ln e;
    // errors this small make the logarithm exact enough.
    let (sigma, heights) = (1e-4, [1.0, 0.6401, 0.4097, 0.2621]);
    let report = Fit::new().sigma_height(sigma).profiles(true).run(&Table::from_heights(&heights).unwrap()).unwrap();
    assert_eq!(report.profiles().len(), 1);
    let profile = &report.profiles()[0];
    assert_eq!((profile.method.name(), profile.points.len()), ("heights", 121));
    for point in &profile.points {
        let e = point.cor;
        let model: Vec<f64> = (0..4).map(|n| e.powi(2 * n)).collect();
        // The release height enters linearly: h_n = h0 e^(2n).
        let h0 = heights.iter().zip(&model).map(|(h, m)| h * m).sum::<f64>() / model.iter().map(|m| m * m).sum::<f64>();
        let cost: f64 = heights.iter().zip(&model).map(|(h, m)| ((h - h0 * m) / sigma).powi(2)).sum();
        assert!((point.chi_square - cost).abs() < 1e-6 * cost.max(1.0), "{e}: {} is not {cost}", point.chi_square);
    }
    assert!(json(&Table::from_heights(&heights).unwrap(), Fit::new()).get("profiles").is_none());
}
