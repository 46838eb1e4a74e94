//! A table says the same in every language in which its headings are understood, with whatever
//! commas its numbers are written.

use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Table, Why};

/// How the heights of release and of the rebound are called.
const DROPS: [[&str; 2]; 41] = [
    ["drop height", "bounce height"],
    ["Fallhöhe", "Rücksprunghöhe"],
    ["hauteur de chute", "hauteur du rebond"],
    ["altura de caída", "altura de rebote"],
    ["altura inicial", "altura do quique"],
    ["altezza di caduta", "altezza di rimbalzo"],
    ["valhoogte", "stuiterhoogte"],
    ["fallhöjd", "studshöjd"],
    ["faldhøjde", "tilbagespringshøjde"],
    ["fallhøyde", "spretthøyde"],
    ["pudotuskorkeus", "pomppukorkeus"],
    ["wysokość upuszczenia", "wysokość odbicia"],
    ["výška pádu", "výška odrazu"],
    ["ejtési magasság", "visszapattanási magasság"],
    ["düşme yüksekliği", "sıçrama yüksekliği"],
    ["высота падения", "высота отскока"],
    ["висота падіння", "висота відскоку"],
    ["下落高度", "反弹高度"],
    ["落下高さ", "はね返り高さ"],
    ["drop [H]", "rebound [h]"],
    ["înălțimea de cădere", "înălțimea ricoșeului"],
    ["ύψος πτώσης", "ύψος αναπήδησης"],
    ["alçada de caiguda", "alçada del rebot"],
    ["visina pada", "visina odskoka"],
    ["višina padca", "višina odboja"],
    ["висина пада", "висина одскока"],
    ["височина на падане", "височина на отскок"],
    ["kukkumiskõrgus", "põrkekõrgus"],
    ["krišanas augstums", "atlēciena augstums"],
    ["kritimo aukštis", "atšokimo aukštis"],
    ["tinggi jatuh", "tinggi pantulan"],
    ["chiều cao thả", "chiều cao nảy"],
    ["ارتفاع السقوط", "ارتفاع الارتداد"],
    ["גובה נפילה", "גובה ניתור"],
    ["ارتفاع رهاسازی", "ارتفاع برگشت"],
    ["गिरने की ऊँचाई", "उछाल की ऊँचाई"],
    ["fallhæð", "hopphæð"],
    ["erorketa altuera", "errebote altuera"],
    ["valhoogte", "bonshoogte"],
    ["uchder gollwng", "uchder adlam"],
    ["釋放高度", "反彈高度"],
];

/// How the number of a bounce and its height, or its time, are called.
const SERIES: [[&str; 3]; 22] = [
    ["bounce", "height", "time"],
    ["Aufprall", "Höhe", "Zeit"],
    ["rebond", "hauteur", "temps"],
    ["bote", "altura", "tiempo"],
    ["studs", "höjd", "tidpunkt"],
    ["hop", "højde", "tidspunkt"],
    ["odbicie", "wysokość", "czas"],
    ["отскок", "высота", "время"],
    ["удар", "высота", "время"],
    ["次数", "高度", "时间"],
    ["バウンド", "高さ", "時間"],
    ["ricoșeu", "înălțime", "timp"],
    ["αναπήδηση", "ύψος", "χρόνος"],
    ["odskok", "visina", "vrijeme"],
    ["отскок", "височина", "време"],
    ["põrge", "kõrgus", "aeg"],
    ["atlēciens", "augstums", "laiks"],
    ["atšokimas", "aukštis", "laikas"],
    ["pantulan ke", "tinggi", "waktu"],
    ["رقم الارتداد", "الارتفاع", "الزمن"],
    ["מספר ניתור", "גובה", "זמן"],
    ["Odraz č.", "Výška", "Čas"],
];

/// How a time, the distance from a sensor and a position are called.
const SENSED: [[&str; 3]; 24] = [
    ["time", "distance", "position"],
    ["Zeit", "Abstand", "Position"],
    ["temps", "distance", "position"],
    ["tiempo", "distancia", "posición"],
    ["tempo", "distância", "posição"],
    ["tempo", "distanza", "posizione"],
    ["tijd", "afstand", "positie"],
    ["tid", "avstånd", "läge"],
    ["tid", "afstand", "position"],
    ["tid", "avstand", "posisjon"],
    ["aika", "etäisyys", "sijainti"],
    ["czas", "odległość", "pozycja"],
    ["čas", "vzdálenost", "poloha"],
    ["idő", "távolság", "pozíció"],
    ["zaman", "mesafe", "konum"],
    ["время", "расстояние", "положение"],
    ["час", "відстань", "положення"],
    ["时间", "距离", "位置"],
    ["時間", "距離", "位置"],
    ["timp", "distanță", "poziție"],
    ["χρόνος", "απόσταση", "θέση"],
    ["vrijeme", "udaljenost", "položaj"],
    ["waktu", "jarak", "posisi"],
    ["الزمن", "المسافة", "الموضع"],
];

/// Headings of every language, and what they are of.
const HEADINGS: &str = include_str!("tables/headings.tsv");

fn cor(text: &str) -> f64 {
    let table = Table::parse("table.csv", text.as_bytes(), &ReadOptions::default())
        .unwrap_or_else(|error| panic!("{error}\n{text}"));
    let report = Fit::new().run(&table).unwrap();
    report.cor().unwrap_or_else(|| panic!("{report}\n{text}")).value
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(200)))]

    #[test]
    fn drops_are_drops_in_every_language(
        language in 0..DROPS.len(),
        e in 0.4..0.92_f64,
        highest in 80.0..200.0_f64,
        rows in 3..7_usize,
        wide in any::<bool>(),
    ) {
        let [drop, rebound] = DROPS[language];
        let unit = if wide { "（ｃｍ）" } else { " (cm)" };
        let mut text = format!("{drop}{unit};{rebound}{unit}\n");
        for row in 0..rows {
            let height = highest * (1.0 - 0.1 * row as f64);
            text += &format!("{height:.1};{:.1}\n", height * e * e).replace('.', ",");
        }
        prop_assert!((cor(&text) - e).abs() < 4e-3, "{}", text);
    }

    #[test]
    fn a_series_is_one_in_every_language(language in 0..SERIES.len(), e in 0.5..0.9_f64, timed in any::<bool>()) {
        let [bounce, height, time] = SERIES[language];
        let (mut h, mut t) = (1.5_f64, (2.0_f64 * 1.5 / 9.81).sqrt());
        let mut text = if timed { format!("{bounce},{time} (s)\n") } else { format!("{bounce},{height} (cm)\n0,{:.1}\n", 100.0 * h) };
        for k in 1..6 {
            h *= e * e;
            text += &if timed { format!("{k},{t:.4}\n") } else { format!("{k},{:.1}\n", 100.0 * h) };
            t += 2.0 * (2.0 * h / 9.81).sqrt();
        }
        prop_assert!((cor(&text) - e).abs() < 1e-2, "{}", text);
    }

    /// What a sensor above a ball, or a film of it, shows in time.
    #[test]
    fn a_recording_is_one_in_every_language(language in 0..SENSED.len(), e in 0.6..0.9_f64, above in any::<bool>()) {
        let [time, distance, position] = SENSED[language];
        let flights = |n: i32| 2.0 * (2.0 * 1.2 / 9.81_f64).sqrt() * e.powi(n);
        let height = |t: f64| {
            let (mut from, mut n) = (0.2 - 0.5 * flights(0), 0);
            while t > from + flights(n) {
                (from, n) = (from + flights(n), n + 1);
            }
            if t < 0.2 { 1.2 } else { 4.905 * (t - from) * (from + flights(n) - t) }
        };
        let rows = (0..110).map(|n| 0.02 * f64::from(n)).map(|t| (t, height(t)));
        let (name, reads) = if above { (distance, 1.6) } else { (position, 0.0) };
        let mut text = format!("{time} (s);{name} (m)\n");
        for (t, h) in rows {
            text += &format!("{t:.3};{:.4}\n", if above { reads - h } else { h });
        }
        prop_assert!((cor(&text) - e).abs() < 1e-2, "{}", text);
    }

    /// Thousands parted by commas, in a table that separates cells by commas.
    #[test]
    fn commas_that_part_thousands(e in 0.5..0.8_f64, highest in 1600..3000_u32) {
        let heights: Vec<u32> = (0..5).map(|k| (f64::from(highest) * e.powi(2 * k)).round() as u32).filter(|&h| h >= 100).collect();
        prop_assume!(heights.iter().any(|&h| h < 1000));
        let plain = |h: u32| h.to_string();
        let parted = |h: u32| if h < 1000 { h.to_string() } else { format!("\"{},{:03}\"", h / 1000, h % 1000) };
        let table = |write: &dyn Fn(u32) -> String| {
            let rows = heights.iter().enumerate().map(|(k, &h)| format!("{k},{}\n", write(h)));
            format!("bounce,height (mm)\n{}", rows.collect::<String>())
        };
        prop_assert_eq!(cor(&table(&plain)), cor(&table(&parted)));
    }
}

/// A table of each kind in each language: drops with what is lost of each and a remark, the heights
/// of three bounces, times in the air, speeds. Every heading is understood.
#[test]
fn headings_are_read_in_every_language() {
    const E: f64 = 0.8;
    let lines = HEADINGS.lines().filter(|line| !line.starts_with('#'));
    for line in lines {
        let names: Vec<&str> = line.split('\t').collect();
        let [_, trial, drop, rebound, first, second, third, air, before, after, lost, remark] = names[..] else {
            panic!("{line}")
        };
        let h = |row: usize, bounce: i32| (150.0 - 10.0 * row as f64) * E.powi(2 * bounce);
        let (mut drops, mut heights) = (String::new(), String::new());
        let (mut flights, mut speeds) = (format!("n;{air} (s)\n"), format!("{before} (m/s);{after} (m/s)\n"));
        for row in 0..5 {
            let gone = h(row, 0) - h(row, 1);
            drops += &format!("{};{:.1};{:.1};{gone:.1};\n", row + 1, h(row, 0), h(row, 1));
            heights += &format!("{};{:.1};{:.1};{:.1};{:.1}\n", row + 1, h(row, 0), h(row, 1), h(row, 2), h(row, 3));
            flights += &format!("{};{:.4}\n", row + 1, 0.9 * E.powi(row as i32));
            speeds += &format!("{:.3};{:.3}\n", 5.0 + row as f64, E * (5.0 + row as f64));
        }
        let drops = format!("{trial};{drop} (cm);{rebound} (cm);{lost} (cm);{remark}\n{drops}");
        let heights = format!("{trial};{drop} (cm);{first} (cm);{second} (cm);{third} (cm)\n{heights}");
        for text in [drops, heights, flights, speeds].iter().filter(|text| !text.contains("- (")) {
            let table = Table::parse("table.csv", text.as_bytes(), &ReadOptions::default())
                .unwrap_or_else(|error| panic!("{error}\n{text}"));
            let unread = table.left_aside().iter().any(|left| left.why == Why::NotUnderstood);
            assert!(!unread, "{:?}\n{text}", table.left_aside());
            let report = Fit::new().run(&table).unwrap();
            let found = report.cor().unwrap_or_else(|| panic!("{report}\n{text}")).value;
            assert!((found - E).abs() < 0.01 && report.groups().is_empty(), "{report}\n{text}");
        }
    }
}
