use super::*;

#[test]
fn titles_state_rates_and_heights() {
    for (text, fps, height) in [
        ("Filmed at 240 fps", Some(240.0), None),
        ("Frame rate: 59.94", Some(59.94), None),
        ("Video mit 120 Bilder/s", Some(120.0), None),
        ("Drop height: 100 cm", None, Some(1.0)),
        ("Drop height (cm) 150", None, Some(1.5)),
        ("Fallhöhe = 1,2 m", None, Some(1.2)),
        ("Ball dropped from 2 m", None, Some(2.0)),
        ("Experiment 3, Table 2", None, None),
        ("The ball was released 5 cm from the edge", None, None),
        ("Expected drop height: 1 m", None, None),
        ("Mass (g) 58", None, None),
        ("TP n°4 : rebonds ; hauteur initiale h0 = 1,50 m", None, Some(1.5)),
        ("Test of batch 3, drop height 305 mm onto a steel block", None, Some(0.305)),
        ("By group 4 on 3 May, dropped from 1.20 m onto the gym floor", None, Some(1.2)),
        ("Predicted for a ball dropped from 1.20 m", None, None),
        ("Bonjour, voici la balle (lâchée de 1,20 m)", None, Some(1.2)),
        ("abbiamo lasciato cadere la pallina da 1 metro.", None, Some(1.0)),
        ("Zorb and I dropped the ball from 1.5 m", None, Some(1.5)),
        ("Air times -- ball dropped from 1.00 m every time", None, Some(1.0)),
        ("ZORB (double zorb) - drop 90 cm", None, Some(0.9)),
        ("Drop height: 254 cm (ITF)", None, Some(2.54)),
        ("Rebound of spheres dropped from 80 cm (ten drops each)", None, Some(0.8)),
        ("Rebound of spheres dropped from 80 cm (predicted)", None, None),
        ("Bollen släpptes från 2,00 m", None, Some(2.0)),
        ("Zorb dropped the ball beside a 2 m rule", None, None),
        ("We dropped the ball and recorded it from 2 m", None, None),
        ("We dropped the ball and filmed it from 2 m", None, None),
        ("Wir haben den Ball immer aus 1,50 m fallen lassen", None, Some(1.5)),
        ("We laten een stuiterbal los op 1,60 m hoogte en lezen af", None, Some(1.6)),
        ("Ball: Spalding   Drop height = 72 cm", None, Some(0.72)),
        ("Dropped from 1 m (100 cm)", None, Some(1.0)),
        ("dropped from 5 ft (1.5 m) onto wood", None, Some(1.524)),
        ("Released from 40 in (1016 mm)", None, Some(1.016)),
        ("Die Fallhöhe war (120,0 ± 0,5) cm", None, Some(1.2)),
        ("Zorb dropped a ball of 5 cm", None, None),
        ("Tennisball aus 2 m auf Parkett", None, Some(2.0)),
        ("Tennis ball from 2 m with a wobble", None, None),
        ("A ball was dropped 180 cm from the wall", None, None),
        ("We dropped the ball next to a 180 cm board", None, None),
        ("The balls were dropped 180 cm from the floor", None, Some(1.8)),
        ("La balle est lâchée de 1,80 m.", None, Some(1.8)),
        ("A labdát 180 cm magasságból ejtettük.", None, Some(1.8)),
        ("Topu 180 cm yükseklikten bıraktık.", None, Some(1.8)),
        ("The ball was let go at 180 cm.", None, Some(1.8)),
        ("Every ball was dropped from the same height (180 cm).", None, Some(1.8)),
        ("Zorb dropped the wobble from 2 m", None, None),
    ] {
        assert_eq!((frame_rate(text), drop(text).map(|drop| drop.metres())), (fps, height), "{text}");
    }
}

#[test]
fn titles_state_units_and_errors() {
    for (text, of_time, metres) in [
        ("All heights in cm", None, Some(0.01)),
        ("Heights in m", None, Some(1.0)),
        ("Times in ms", Some(0.001), None),
        ("Alle Höhen in cm", None, Some(0.01)),
        ("Height of the wobble in m", None, None),
        ("They wobbled all in m", None, None),
        ("Drop height in cm", None, None),
        ("Ball diameter in cm", None, None),
        ("Bounce 1 in cm", None, None),
    ] {
        let found = unit(text).map(|unit| (unit.dimension, unit.si(1.0)));
        let expected = of_time.map(|s| (Dimension::Time, s)).or(metres.map(|m| (Dimension::Length, m)));
        assert_eq!(found, expected, "{text}");
    }
    for (text, metres) in [
        ("Rebound heights (cm) - every ball dropped from 1.00 m", Some(0.01)),
        ("peak height in metres (first number = where it was dropped)", Some(1.0)),
        ("(cm, read at the bottom of the ball)", Some(0.01)),
        ("(m, read by Ann)", None),
        ("Rebound height in cm of a zorb dropped from 2 m", Some(0.01)),
        ("Rebound height in cm of the release", None),
        ("Rebound height in cm predicted by Ann", None),
    ] {
        assert_eq!(of_clauses(text).map(|unit| unit.si(1.0)), metres, "{text}");
    }
    for (text, metres) in [
        ("all in cm", Some(0.01)),
        ("here are the numbers (cm):", Some(0.01)),
        ("ball (cm)", None),
        ("the wobbles (cm)", None),
        ("drop (cm)", None),
    ] {
        assert_eq!(of_all(text).map(|unit| unit.si(1.0)), metres, "{text}");
    }
    for (text, expected) in [
        ("Uncertainty in heights: ±1 cm", Some((0.01, Dimension::Length))),
        ("Heights ± 5 mm", Some((0.005, Dimension::Length))),
        ("Error of times = 0.01 s", Some((0.01, Dimension::Time))),
        ("Heights read with a tape, uncertainty 1 cm.", Some((0.01, Dimension::Length))),
        ("La pelota se deja caer desde 1,80 m", None),
        ("Uncertainty in heights: 0.01 s", None),
        ("Diameter: 6.7 cm", None),
        ("Heights were wobbly: ± 1 cm", None),
    ] {
        assert_eq!(error(text), expected, "{text}");
    }
}
