//! What files say otherwise than by the names of columns: by their own name, by what joins the
//! cells of LaTeX, by the numbers of a signal, by a line of which nothing was read.

use crate::film::{Ball, Contact, noisy};
use crate::noise::Noise;
use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Report, Table, TableError, Verdict};

fn near(found: f64, e: f64, by: f64) -> bool {
    (found - e).abs() < by
}

fn named(name: &str, text: &str) -> Result<Report, TableError> {
    Table::parse(name, text.as_bytes(), &ReadOptions::default()).map(|table| Fit::new().run(&table).unwrap())
}

/// Heights of release, and of rebound, cm.
fn drops(e: f64) -> Vec<(f64, f64)> {
    [200.0, 180.0, 160.0, 120.0, 100.0, 80.0, 60.0].map(|h: f64| (h, (h * e * e * 10.0).round() / 10.0)).to_vec()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// The name of a file says its columns where it has no names, in either order: a rebound is
    /// lower than its drop.
    #[test]
    fn the_name_of_a_file_says_its_columns(
        e in 0.5..0.9_f64,
        name in prop::sample::select(vec![
            "drop_vs_rebound_cm.csv", "rebound vs drop (cm).csv", "drop_cm_rebound_cm.csv",
            "drop_height_and_bounce_height_in_cm.csv", "Fallhöhe-Rücksprunghöhe_cm.csv",
            "hauteur de chute_hauteur de rebond_cm.csv", "2_drop_vs_rebound_cm.csv",
        ]),
        turned in any::<bool>(),
    ) {
        let rows: String = drops(e).iter().map(|(h, r)| if turned { format!("{r},{h}\n") } else { format!("{h},{r}\n") }).collect();
        let report = named(name, &rows).unwrap();
        prop_assert!(near(report.cor().unwrap().value, e, 0.005), "{}", report);
        // Other names say nothing, and numbers that are no rebounds are none.
        for name in ["data_cm.csv", "golf_tennis_cm.csv", "zorb_vs_rebound_cm.csv", "results.csv"] {
            prop_assert!(named(name, &rows).is_err(), "{}", name);
        }
        let mixed = rows + "50,100\n100,50\n";
        prop_assert!(named(name, &mixed).is_err());
    }

    /// A number by itself above rows of several, as programs write what else they keep, is none of
    /// them, however the rows begin.
    #[test]
    fn a_number_above_rows_of_several_is_none_of_them(
        (e, cor) in prop::sample::select(vec![(0.66, (|_| 0.66) as fn(f64) -> f64), (0.74, |_| 0.74), (0.83, |_| 0.83)]),
        kept in prop::sample::select(vec!["120\n", "# name: fps\n# type: scalar\n60\n\n\n", "30\n2024\n", ""]),
        indent in prop::sample::select(vec!["", " ", "   "]),
    ) {
        let ball = Ball { drop: 1.1, release: 0.2, gravity: 9.81, drag: 0.0, cor, contact: Contact::Instant };
        let film = noisy(&ball.film(60.0, 2.4), &mut Noise(12), 1e-3);
        let rows: String = film.iter().map(|(t, y)| format!("{indent}{t:.6} 0.004 {y:.4}\n")).collect();
        let report = fit(&format!("{kept}# name: traj\n{rows}"));
        prop_assert!(near(report.cor().unwrap().value, e, 0.01), "{}", report);
    }

    /// What joins two columns of LaTeX makes one cell of theirs, an error or the digits behind a
    /// point, and a name may span both.
    #[test]
    fn joined_columns_of_latex_are_one_cell(e in 0.5..0.9_f64, form in 0_usize..4) {
        let (spec, release, rebound): (_, &dyn Fn(f64) -> String, &dyn Fn(f64) -> String) = match form {
            0 => (r"c r@{$\,\pm\,$}l r@{$\,\pm\,$}l", &|h| format!("{h} & 1"), &|h| format!("{h} & 3")),
            1 => (r"|c|r@{ $\pm$ }l|r@{ $\pm$ }l|", &|h| format!("{h:.1} & 0.5"), &|h| format!("{h:.1} & 0.5")),
            2 => (r"c r@{.}l r@{.}l", &|h| format!("{h:.1}").replace('.', " & "), &|h| format!("{h:.1}").replace('.', " & ")),
            _ => (r"@{}l>{\bfseries}r@{,}l p{2cm}@{,}l@{}", &|h| format!("{h:.1}").replace('.', " & "), &|h| format!("{h:.1}").replace('.', " & ")),
        };
        let rows: String = drops(e).iter().enumerate().map(|(n, (h, r))| format!("  {n} & {} & {} \\\\\n", release(*h), rebound(*r))).collect();
        let text = format!(
            "\\begin{{table}}\n\\caption{{Stahlkugel. Fallhöhe $h_0$ und Steighöhe $h_1$.}}\n\\begin{{tabular}}{{{spec}}}\n\\toprule\n\
             Nr. & \\multicolumn{{2}}{{c}}{{$h_0$ / cm}} & \\multicolumn{{2}}{{c}}{{$h_1$ / cm}} \\\\\n\\midrule\n{rows}\\bottomrule\n\
             \\end{{tabular}}\n\\end{{table}}\n"
        );
        let report = fit(&text);
        prop_assert!(near(report.cor().unwrap().value, e, 0.006), "{}\n{}", text, report);
    }

    /// A name that spans several columns of LaTeX, above names of their own.
    #[test]
    fn a_name_may_span_columns_of_latex(e in 0.5..0.9_f64) {
        let rows: String = drops(e).iter().map(|(h, r)| format!("{h} & {r} & {:.1} & {:.1} \\\\\n", r * 1.004, r * 0.997)).collect();
        let text = format!(
            "\\begin{{tabular}}{{l c c c}}\n & \\multicolumn{{3}}{{c}}{{Rebound height (cm)}} \\\\\n\
             Drop height (cm) & Trial 1 & Trial 2 & Trial 3 \\\\\n\\hline\n{rows}\\end{{tabular}}\n"
        );
        prop_assert!(near(trusted(&text), e, 0.006));
    }

    /// Peaks of a signal beside the times of contacts are no heights, which are as the squares of
    /// the flights; where they are as these, their unit is asked, or the times alone answer.
    #[test]
    fn peaks_of_a_signal_are_no_heights(
        e in 0.7..0.89_f64,
        form in prop::sample::select(vec!["HIT {n} t={t} us peak={p}", "bounce {n}: t = {t} us, peak = {p}", "impact {n} t_us={t} peak={p}"]),
        retriggers in any::<bool>(),
        real in any::<bool>(),
    ) {
        let (mut t, mut text) = (3_479_449.0, "Bounce timer v0.3\nready\n".to_owned());
        for n in 0..9 {
            let flight = 689_000.0 * e.powi(n);
            let peak = if real { 874.0 * e.powi(2 * n) } else { 874.0 * 0.87f64.powi(n).sqrt() * e.sqrt().powi(n) };
            let line = form.replace("{n}", &(n + 1).to_string()).replace("{t}", &format!("{t:.0}"));
            text += &format!("{}\n", line.replace("{p}", &format!("{peak:.0}")));
            if retriggers && n == 3 {
                text += "(retrigger after 4 ms ignored)\n";
            }
            t += flight;
        }
        match read(&text) {
            Err(error) => prop_assert!(real && error.is_question(), "{}\n{}", text, error),
            Ok(table) => {
                let report = Fit::new().run(&table).unwrap();
                prop_assert!(near(report.cor().unwrap().value, e, 0.005), "{}\n{}", text, report);
            }
        }
    }

    /// A bounce of which nothing was read keeps its place: those after it count on.
    #[test]
    fn a_missed_bounce_leaves_a_gap(
        e in 0.7..0.9_f64,
        miss in 2..6_usize,
        words in prop::sample::select(vec![
            ("Stuiterbal op tegelvloer, losgelaten op 2,00 m. Hoogten in cm:", "{n}e stuit", "gemist (Daan liep door beeld)", ""),
            ("Labjournaal\ndinsdag 6 feb\nProef: stuiterbal op tegelvloer, losgelaten op 2,00 m. Gefilmd met iPad.\nHoogten afgelezen, in cm:", "{n}e stuit", "gemist", ""),
            ("Ball dropped from 2.00 m.", "bounce {n}", "missed", " cm"),
            ("Ball fallen gelassen aus 2,00 m.", "{n}. Sprung", "verpasst (Kamera)", " cm"),
            ("Balle lâchée de 2,00 m.", "{n}e rebond", "raté", " cm"),
            ("Pelota soltada desde 2,00 m.", "{n}º rebote", "no se vio", " cm"),
        ]),
        below in any::<bool>(),
    ) {
        let (title, name, missing, unit) = words;
        let line = |n: usize| {
            let height = if n == miss { missing.to_owned() } else { format!("{:.1}{unit}", 200.0 * e.powi(2 * n as i32)) };
            format!("  {}: {height}\n", name.replace("{n}", &n.to_string()))
        };
        let end = if below { "\nMassa bal 31 g, diameter 3,9 cm.\n" } else { "" };
        let text = format!("{title}\n\n{}{end}", (1..8).map(line).collect::<String>());
        let report = fit(&text);
        prop_assert!(near(report.cor().unwrap().value, e, 0.004), "{}\n{}", text, report);
        prop_assert!(report.verdict() != Verdict::Refused, "{}", report);
    }
}
