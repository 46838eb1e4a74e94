//! Sounds: the contacts of a ball are found among all else that is heard, and nothing else is
//! taken for them without a doubt.

#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]

mod made;

use std::fmt::Write as _;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use hound::{SampleFormat, WavSpec, WavWriter};
use made::{Kind, Made, make};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Contact, Doubt, FindingKind, Fit, Note, ReadOptions, Report, Sound, Table, Verdict};

/// A contact is found if a time is as near to it, s.
const NEAR: f64 = 0.003;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn heard(made: &Made) -> Option<Sound> {
    Sound::of("made", made.rate, &made.samples).ok()
}

fn fitted(sound: Sound) -> Report {
    Fit::new().run(&Table::from_sound(sound)).unwrap()
}

/// Whether the report itself says that chance, or something else, may have made the contacts.
fn is_doubted(report: &Report) -> bool {
    let doubted = |doubt: &Doubt| matches!(doubt, Doubt::Chance { .. } | Doubt::Undying { .. });
    report.findings().iter().any(|finding| matches!(&finding.kind, FindingKind::ReadDoubt { doubt } if doubted(doubt)))
}

fn near(t: f64, times: impl IntoIterator<Item = f64>) -> bool {
    times.into_iter().any(|other| (t - other).abs() < NEAR)
}

fn wav(spec: WavSpec, samples: &[f32]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = WavWriter::new(&mut bytes, spec).unwrap();
    let full = (f64::from(spec.bits_per_sample) - 1.0).exp2();
    for &x in samples {
        match spec.sample_format {
            SampleFormat::Float => writer.write_sample(x).unwrap(),
            SampleFormat::Int => writer.write_sample((f64::from(x) * full).clamp(-full, full - 1.0) as i32).unwrap(),
        }
    }
    writer.finalize().unwrap();
    bytes.into_inner()
}

fn spec(rate: u32, channels: u16, bits_per_sample: u16, sample_format: SampleFormat) -> WavSpec {
    WavSpec { channels, sample_rate: rate, bits_per_sample, sample_format }
}

#[test]
fn a_table_tennis_ball_of_which_the_cor_was_read_off_by_hand() {
    let table = Table::read(&root().join("examples/data/pingpong.wav"), &ReadOptions::default()).unwrap();
    let report = Fit::new().run(&table).unwrap();
    let cor = report.cor().unwrap();
    assert_eq!(report.verdict(), Verdict::Trusted);
    assert!((cor.value - 0.9448).abs() < 0.001, "{cor:?}");
    assert!(cor.low < 0.9448 && 0.9448 < cor.high && cor.high - cor.low < 0.02, "{cor:?}");
    let times: Vec<f64> = table.sounds()[0].drops()[0].iter().map(|contact| contact.time).collect();
    assert!(times.len() >= 20 && (times[0] - 0.127).abs() < 0.001, "{times:?}");
    assert_eq!(report.left_aside().len(), 3, "{:?}", report.left_aside());
}

#[test]
fn a_ball_with_echoes_that_others_recorded() {
    let path = root().join("../shared/data/sound_pisa/Audio.wav");
    if !path.exists() {
        eprintln!("skipped: {} is not here", path.display());
        return;
    }
    let table = Table::read(&path, &ReadOptions::default()).unwrap();
    // What its authors read off, the earliest and the latest; of the onset or of what follows.
    let read = [0.254, 1.340, 2.195, 2.884, 3.440, 3.894, 4.260, 4.564, 4.816, 5.017];
    let times: Vec<f64> = table.sounds()[0].drops()[0].iter().map(|contact| contact.time).collect();
    assert_eq!(times.len(), read.len(), "{times:?}");
    assert!(times.iter().zip(read).all(|(t, read)| (t - read).abs() < 0.01), "{times:?}");
    let report = Fit::new().run(&table).unwrap();
    assert!((report.cor().unwrap().value - 0.810).abs() < 0.003, "{:?}", report.cor());
    let text = report.to_string();
    assert!(text.contains("falls with speed"), "the first ratio is the lowest: {text}");
}

/// Of each kind so many, by default a few: `SOUNDS=200 SALTUS_BLESS=1 cargo test -p saltus-fit
/// sound::made_sounds` writes the table of docs/use/sound.md.
#[test]
fn made_sounds_are_heard_or_refused() {
    let count: u64 = std::env::var("SOUNDS").ok().map_or(u64::from(cases(25)), |count| count.parse().unwrap());
    let mut table = String::from(
        "| sound | heard | doubted | refused | contacts found | false | COR off, median | 95 % | trusted and wrong |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for kind in Kind::ALL {
        let (mut sure, mut doubted, mut refused, mut wrong) = (0, 0, 0, 0);
        let (mut found, mut all, mut false_ones) = (0, 0, 0);
        let mut off = Vec::new();
        for seed in 0..count {
            let made = make(kind, seed);
            let Some(sound) = heard(&made) else {
                refused += 1;
                continue;
            };
            let times: Vec<f64> = sound.drops().iter().flatten().map(|contact| contact.time).collect();
            let report = fitted(sound);
            if is_doubted(&report) {
                doubted += 1;
                assert_ne!(report.verdict(), Verdict::Trusted, "{kind:?} {seed}");
            } else {
                sure += 1;
            }
            if !kind.has_ball() {
                wrong += usize::from(report.verdict() == Verdict::Trusted);
                continue;
            }
            all += made.contacts.len();
            found += made.contacts.iter().filter(|&&t| near(t, times.iter().copied())).count();
            false_ones += times.iter().filter(|&&t| !near(t, made.contacts.iter().copied())).count();
            let Some(cor) = report.cor() else { continue };
            let by = (cor.value - made.cor).abs();
            wrong += usize::from(report.verdict() == Verdict::Trusted && by > 0.02);
            off.push(by);
        }
        off.sort_by(f64::total_cmp);
        let part = |part: f64| {
            off.get((part * off.len().saturating_sub(1) as f64) as usize).map_or("-".to_owned(), |x| format!("{x:.4}"))
        };
        let of_all =
            |n: usize| if all == 0 { "-".to_owned() } else { format!("{:.0} %", 100.0 * n as f64 / all as f64) };
        let _ = writeln!(
            table,
            "| {} | {sure} | {doubted} | {refused} | {} | {} | {} | {} | {wrong} |",
            kind.about(),
            of_all(found),
            of_all(false_ones),
            part(0.5),
            part(0.95)
        );
        assert!(wrong * 100 <= count as usize, "{kind:?}: {wrong} of {count} trusted and wrong");
        // As far as chance takes it among other sounds of the kind.
        let [least, most, part] = kind.expected();
        let [heard, none] = [f64::from(sure), f64::from(refused)].map(|of| of / count as f64);
        let room = |share: f64| (1.0 + 3.0 * (count as f64 * share * (1.0 - share)).sqrt()) / count as f64;
        assert!(heard >= least - room(least), "{kind:?}: {sure} heard");
        if kind.has_ball() {
            assert!(none <= most + room(most), "{kind:?}: {refused} refused");
        } else {
            assert!(heard <= 0.01 && none >= most - room(most), "{kind:?}: {sure} heard, {refused} refused");
        }
        assert!(found as f64 >= 0.95 * part * all as f64, "{kind:?}: {found} of {all} found");
        assert!(false_ones * 50 <= found.max(100), "{kind:?}: {false_ones} false");
    }
    eprintln!("{table}");
    if std::env::var_os("SOUNDS").is_none() {
        return;
    }
    let page = root().join("docs/use/sound.md");
    let text = std::fs::read_to_string(&page).unwrap();
    let (from, to) = ("<!-- written by the test sound: begin -->\n", "<!-- end -->");
    let begin = text.find(from).unwrap() + from.len();
    let end = begin + text[begin..].find(to).unwrap();
    if std::env::var_os("SALTUS_BLESS").is_some() {
        std::fs::write(&page, format!("{}{table}{}", &text[..begin], &text[end..])).unwrap();
    }
}

fn contacts(sound: &Sound) -> Vec<Contact> {
    sound.drops().concat()
}

#[test]
fn every_format_of_wav_is_the_same_sound() {
    let made = make(Kind::Clean, 3);
    let whole = contacts(&heard(&made).unwrap());
    let formats = [
        (8, SampleFormat::Int),
        (16, SampleFormat::Int),
        (24, SampleFormat::Int),
        (32, SampleFormat::Int),
        (32, SampleFormat::Float),
    ];
    for (bits, format) in formats {
        for channels in [1_u16, 2] {
            let silent = |x: &f32| std::iter::once(*x).chain((1..channels).map(|_| 0.0)).collect::<Vec<_>>();
            let frames: Vec<f32> = made.samples.iter().flat_map(silent).collect();
            let bytes = wav(spec(made.rate, channels, bits, format), &frames);
            let table = Table::parse("made.wav", &bytes, &ReadOptions::default()).unwrap();
            let found = contacts(&table.sounds()[0]);
            let shared = found.len().min(whole.len());
            assert!(shared >= 5, "{bits} bits, {channels} channels: {} of {}", found.len(), whole.len());
            for (a, b) in found.iter().zip(&whole) {
                assert!((a.time - b.time).abs() < 0.0005, "{bits} bits, {channels} channels: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn a_recording_given_twice_counts_once() {
    let path = root().join("examples/data/pingpong.wav");
    let twice = Table::read_all(&[&path, &path], &ReadOptions::default()).unwrap();
    assert_eq!((twice.trials().len(), twice.sounds().len()), (1, 1));
    let report = Fit::new().run(&twice).unwrap();
    assert!(report.to_string().contains("pingpong.wav"), "the copy is named: {report}");
}

#[test]
fn a_part_of_a_recording_is_listened_to_on_its_own() {
    let (one, other) = (make(Kind::Clean, 5), make(Kind::Clean, 6));
    let other = Made { rate: one.rate, ..other };
    let joined: Vec<f32> = one.samples.iter().chain(&other.samples).copied().collect();
    let bytes = wav(spec(one.rate, 1, 16, SampleFormat::Int), &joined);
    let all = Table::parse("two.wav", &bytes, &ReadOptions::default()).unwrap();
    assert_eq!(all.trials().len(), 2, "{:?}", all.sounds()[0].drops());
    let seam = one.samples.len() as f64 / f64::from(one.rate);
    let options = ReadOptions::default().listen(seam..f64::INFINITY);
    let later = Table::parse("two.wav", &bytes, &options).unwrap();
    let [whole, part] = [&all.sounds()[0].drops()[1], &later.sounds()[0].drops()[0]];
    assert!(whole.iter().zip(part).all(|(a, b)| (a.time - b.time).abs() < 1e-9), "{whole:?} {part:?}");
    let beyond = ReadOptions::default().listen(1e3..2e3);
    let error = Table::parse("two.wav", &bytes, &beyond).unwrap_err().to_string();
    assert!(error.contains("nothing is left to listen to"), "{error}");
}

#[test]
fn what_is_no_sound_of_a_ball_is_refused_with_what_is_heard() {
    let silence = wav(spec(44_100, 1, 16, SampleFormat::Int), &vec![0.0; 44_100]);
    let error = Table::parse("silence.wav", &silence, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("nothing stands out") && error.contains("--listen"), "{error}");
    let mut knock = vec![0.0_f32; 44_100];
    (0..80).for_each(|k| knock[20_000 + k] = if k % 8 < 4 { 0.5 } else { -0.5 });
    let knock = wav(spec(44_100, 1, 16, SampleFormat::Int), &knock);
    let error = Table::parse("knock.wav", &knock, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("one sound stands out from the noise, at 0.45 s"), "{error}");
    let error = Table::parse("drop.csv", b"bounce,height_cm\n0,100\n1,64\n", &ReadOptions::default().listen(0.0..1.0));
    assert!(error.unwrap_err().to_string().contains("no sound"));
    for (name, bytes) in [("drop.m4a", &b"\0\0\0\x20ftypM4A \0"[..]), ("drop.mp3", b"ID3\x04"), ("drop.ogg", b"OggS")] {
        let error = Table::parse(name, bytes, &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("ffmpeg -i drop.m4a drop.wav"), "{error}");
    }
}

#[test]
fn files_that_are_cut_off_or_damaged_are_read_or_refused() {
    let made = make(Kind::Clean, 3);
    let bytes = wav(spec(made.rate, 1, 16, SampleFormat::Int), &made.samples);
    for cut in [0, 4, 12, 20, 36, 43, 44, 45, 46, 1000, bytes.len() / 2, bytes.len() - 1] {
        let _ = Table::parse("cut.wav", &bytes[..cut], &ReadOptions::default());
    }
    let half = Table::parse("cut.wav", &bytes[..bytes.len() * 3 / 4], &ReadOptions::default()).unwrap();
    assert!(contacts(&half.sounds()[0]).len() >= 3);
    for at in 0..60.min(bytes.len()) {
        for change in [1, 0x80, 0xff] {
            let mut damaged = bytes.clone();
            damaged[at] ^= change;
            let _ = Table::parse("damaged.wav", &damaged, &ReadOptions::default());
        }
    }
}

#[test]
fn what_is_overdriven_is_noted() {
    let noted = |gain: f32| {
        let made = make(Kind::Clean, 3);
        let loudest = made.samples.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
        let samples: Vec<f32> = made.samples.iter().map(|x| (gain * x / loudest).clamp(-1.0, 1.0)).collect();
        let table = Table::from_sound(Sound::of("made", made.rate, &samples).unwrap());
        table.notes().iter().any(|note| matches!(note.kind, Note::Overdriven { .. }))
    };
    assert!(!noted(0.9) && noted(20.0));
}

#[test]
fn noise_that_stops_before_the_drop_hides_nothing() {
    let made = make(Kind::Clean, 3);
    let mut noise = 1_u32;
    let loud = (0..10 * made.rate).map(|_| {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f32::from((noise >> 16) as u16) / 65_536.0 - 0.5
    });
    let samples: Vec<f32> = loud.chain(made.samples.iter().copied()).collect();
    let (alone, after) = (heard(&made).unwrap(), Sound::of("after", made.rate, &samples).unwrap());
    let late = f64::from(10 * made.rate) / f64::from(made.rate);
    assert_eq!(alone.drops()[0].len(), after.drops()[0].len());
    for (a, b) in alone.drops()[0].iter().zip(&after.drops()[0]) {
        assert!((b.time - late - a.time).abs() < 1e-4, "{a:?} {b:?}");
    }
}

#[test]
fn an_hour_of_noise_before_the_drop_hides_nothing() {
    let made = make(Kind::Clean, 3);
    let rate = 8000;
    let step = f64::from(made.rate) / f64::from(rate);
    let drop: Vec<f32> =
        (0..(made.samples.len() as f64 / step) as usize).map(|k| made.samples[(k as f64 * step) as usize]).collect();
    let mut noise = 1_u32;
    let mut samples: Vec<f32> = (0..3600 * rate)
        .map(|_| {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f32::from((noise >> 16) as u16) * 1e-8
        })
        .collect();
    samples.extend(&drop);
    let sound = Sound::of("hour", rate, &samples).unwrap();
    let first = sound.drops()[0][0].time - 3600.0;
    assert!((first - made.contacts[0]).abs() < 0.002, "{first} {}", made.contacts[0]);
    assert!(sound.wave().stretches.len() <= 2048);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(24)))]

    /// The contacts are the same however loud the sound is, whichever way its samples point, and
    /// whenever it begins.
    #[test]
    fn loudness_sign_and_delay_change_nothing(seed in 0_u64..400, gain in 0.05_f32..1.0, flip: bool, delay in 0.0_f64..2.0) {
        let made = make(Kind::Clean, seed);
        let Some(sound) = heard(&made) else { return Ok(()) };
        let silent = (delay * f64::from(made.rate)) as usize;
        let sign = if flip { -gain } else { gain };
        let noise = |k: usize| if k.is_multiple_of(2) { 1e-4 * gain } else { -1e-4 * gain };
        let samples: Vec<f32> = (0..silent).map(noise).chain(made.samples.iter().map(|x| sign * x)).collect();
        let shifted = Sound::of("shifted", made.rate, &samples).unwrap();
        let late = silent as f64 / f64::from(made.rate);
        let (a, b) = (contacts(&sound), contacts(&shifted));
        let same = a.iter().filter(|a| b.iter().any(|b| (b.time - late - a.time).abs() < 0.0005)).count();
        // The faintest may be lost among what is no longer the noise.
        prop_assert!(10 * same >= 9 * a.len().max(b.len()) - 9, "{} {} {}", same, a.len(), b.len());
    }
}

/// Two balls dropped one after the other have a COR each; of one ball the drops are of one COR.
#[test]
fn drops_of_two_balls_are_told_apart() {
    let clean = |least: f64, most: f64| {
        let mut seeds = (0..200).map(|seed| make(Kind::Clean, seed));
        seeds.find(|made| (least..most).contains(&made.cor) && made.rate == 44_100 && made.contacts.len() > 8).unwrap()
    };
    let (one, other) = (clean(0.70, 0.78), clean(0.85, 0.92));
    let after = |second: &Made| {
        let samples: Vec<f32> = one.samples.iter().chain(&second.samples).copied().collect();
        fitted(Sound::of("two", one.rate, &samples).unwrap())
    };
    let (two, same) = (after(&other), after(&one));
    let cors: Vec<f64> = two.groups().iter().filter_map(|group| Some(group.report.cor()?.value)).collect();
    assert!(cors.len() == 2 && near_cor(cors[0], one.cor) && near_cor(cors[1], other.cor), "{cors:?}");
    assert!(same.groups().is_empty() && near_cor(same.cor().unwrap().value, one.cor), "{same}");
}

fn near_cor(found: f64, planted: f64) -> bool {
    (found - planted).abs() < 0.015
}
