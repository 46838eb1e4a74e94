//! What people tell around their tables, in many languages: what was used and where is no doubt,
//! what changes the readings is; conditions, floors and the end of the ball are understood.

use crate::typed::{fit, trusted};
use saltus_fit::{Report, Verdict};

fn drops(said: &str, e: f64) -> String {
    let row = |(n, drop): (usize, f64)| format!("{drop};{:.1}\n", drop * e * e * (1.0 + 0.004 * (n % 3) as f64));
    let rows: String = [60.0, 80.0, 100.0, 120.0, 140.0].into_iter().enumerate().map(row).collect();
    format!("{said}\n\ndrop height (cm);rebound height (cm)\n{rows}")
}

#[test]
fn what_was_used_and_where_is_no_doubt() {
    for said in [
        "Equipment: retort stand, two light gates, steel ball 20 mm, granite slab",
        "Serial monitor COM3 115200 baud - sketch knock_timer v2.1",
        "Приборы: штатив, линейка, секундомер, стальной шарик 15 мм",
        "Прилади: штатив, лінійка, секундомір, гумовий м'яч",
        "器材：直尺、手机、钢板、天平",
        "スマホで録音し、アプリで音の間隔を読み取った。",
        "장소: 학교 체육관 마루, 준비물: 줄자, 스마트폰, 농구공",
        "कक्षा 9, राजकीय विद्यालय। सतह: सीमेंट का फर्श",
        "Dụng cụ: thước dây, điện thoại, bóng cao su, sàn gạch",
        "Alat: meteran, stopwatch, bola tenis, lantai keramik",
        "الأدوات: مسطرة، ميزان، كرة، بلاط",
    ] {
        assert!((trusted(&drops(said, 0.75)) - 0.75).abs() < 0.02, "{said}");
    }
}

#[test]
fn what_changes_readings_is_a_doubt_in_any_language() {
    for said in [
        "Equipment: stand, light gate, a ball that was thrown down hard",
        "м'яч не відпускали, а кидали з силою",
        "значення вигадані",
        "球是用力扔下的",
        "数据是估计的，没有测量",
        "直尺滑动了",
        "ボールを投げ下ろした",
        "値は教科書から写した",
        "定規がずれていた",
        "공을 세게 던졌다",
        "값은 대충 적은 것이다",
        "गेंद को जोर से फेंका गया",
        "ये मान अनुमान से लिखे हैं",
        "bóng bị ném mạnh xuống",
        "số liệu chép từ sách giáo khoa",
        "bolanya dilempar ke bawah",
        "data simulasi, belum diukur",
        "الكرة رميت بقوة",
        "القيم تقديرية",
        "lopta je bacena",
        "brojevi su prepisani iz udžbenika",
    ] {
        let report = fit(&drops(said, 0.75));
        assert!(report.verdict() != Verdict::Trusted, "{said}\n{report}");
    }
    for denied in ["没有用力，自由落下", "投げずに静かに落とした", "공을 던지지 않고 놓았다"]
    {
        assert!((trusted(&drops(denied, 0.75)) - 0.75).abs() < 0.02, "{denied}");
    }
}

fn cors(report: &Report) -> Vec<f64> {
    assert_eq!(report.verdict(), Verdict::Trusted, "{report}");
    report.groups().iter().map(|g| g.report.cor().unwrap().value).collect()
}

#[test]
fn conditions_and_floors_tell_columns_apart() {
    for [drop, one, other] in [
        ["výška pádu [cm]", "odskok při 5 °C [cm]", "odskok při 40 °C [cm]"],
        ["Fallhöhe (cm)", "Rücksprunghöhe Hallenboden (cm)", "Rücksprunghöhe Beton (cm)"],
        ["drop height (cm)", "rebound height rubber mat (cm)", "rebound height concrete (cm)"],
    ] {
        let row = |(n, h): (usize, f64)| {
            let by = 1.0 + 0.003 * (n % 3) as f64;
            format!("{h:.0}\t{:.1}\t{:.1}\n", h * 0.36 * by, h * 0.49 * by)
        };
        let rows: String = [80.0, 100.0, 120.0, 150.0].into_iter().enumerate().map(row).collect();
        let found = cors(&fit(&format!("Ball\n{drop}\t{one}\t{other}\n{rows}")));
        assert!(matches!(found[..], [a, b] if (a - 0.6).abs() < 0.02 && (b - 0.7).abs() < 0.02), "{one} {found:?}");
    }
}

#[test]
fn heights_of_the_top_of_the_ball_are_too_high_by_its_size() {
    let rows = |size: f64| {
        let row = |(n, h): (usize, f64)| {
            format!("{:.1};{:.1}\n", h + size, h * 0.5625 * (1.0 + 0.003 * (n % 3) as f64) + size)
        };
        [60.0, 90.0, 120.0, 150.0].into_iter().enumerate().map(row).collect::<String>()
    };
    for (size, drop, rebound) in [
        ("Ball, diameter 6.6 cm", "drop height (top), cm", "rebound height (top), cm"),
        ("М'яч, діаметр 6,6 см", "Висота падіння (верх), см", "Висота відскоку (верх), см"),
        ("Ball, Durchmesser 6,6 cm", "Fallhöhe (Oberkante), cm", "Rückprallhöhe (Oberkante), cm"),
    ] {
        let names = format!("{drop};{rebound}");
        assert!((trusted(&format!("{size}\n{names}\n{}", rows(6.6))) - 0.75).abs() < 0.01, "{names}");
        // How large it is nobody says.
        assert!(fit(&format!("Ball\n{names}\n{}", rows(6.6))).verdict() != Verdict::Trusted, "{names}");
    }
    for said in ["The tape was fixed so that the floor is at 9.0 cm", "Måleren var festet slik at gulvet er ved 9,0 cm"]
    {
        assert!(
            (trusted(&format!("Ball\n{said}\ndrop height (cm);rebound height (cm)\n{}", rows(9.0))) - 0.75).abs()
                < 0.01,
            "{said}"
        );
    }
}

#[test]
fn other_ways_to_state_a_drop_and_a_speed_are_read() {
    for said in [
        "Pallo (koko 5) pudotettiin koulun pihalle 160 cm korkeudelta.",
        "落下高度160厘米",
        "ボールの落下高さ160センチ",
    ] {
        let text = format!("{said}\ntrial;rebound height (cm)\n1;90.1\n2;89.6\n3;90.4\n4;90.0\n");
        assert!((trusted(&text) - 0.75).abs() < 0.01, "{text}");
    }
    let row = |(n, v): (usize, f64)| format!("{};{:.0};{:.0}\n", n + 1, -v, 0.6 * v * (1.0 + 0.004 * (n % 3) as f64));
    let rows: String = [2000.0, 2150.0, 2200.0, 2300.0].into_iter().enumerate().map(row).collect();
    for names in
        ["vz before (mm/s);vz after (mm/s)", "vy avant (mm/s);vy après (mm/s)", "v_y vorher (mm/s);v_y nachher (mm/s)"]
    {
        assert!((trusted(&format!("grain on a plate\nn;{names}\n{rows}")) - 0.6).abs() < 0.01, "{names}");
    }
    // Beside the time until it rests a height by itself is that of the release, and doubted.
    let until = |h: f64| (2.0 * h / 9.81).sqrt() * (1.0 + 0.9) / (1.0 - 0.9);
    let rows: String = [0.2f64, 0.3, 0.4, 0.5].iter().map(|h| format!("{:.0};{:.2}\n", 100.0 * h, until(*h))).collect();
    let report = fit(&format!("steel ball bounces on glass\nh (cm);total time until rest (s)\n{rows}"));
    assert!((report.cor().unwrap().value - 0.9).abs() < 0.01 && report.verdict() == Verdict::Doubtful, "{report}");
}
