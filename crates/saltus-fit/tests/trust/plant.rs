//! Planted experiments: a true ball, a way of recording it, and a fault.

use super::ball::{Ball, G};
use crate::noise::Noise;
use saltus_fit::{Fit, ReadOptions};

/// What is recorded of a ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The heights of one drop.
    Heights,
    /// A drop and its rebound a row, from several heights.
    Drops,
    /// When one ball, or each of a few, touches the floor.
    Times,
    /// The times between contacts.
    Intervals,
    /// Heights and contact times of one drop.
    Both,
    /// A film in metres.
    Film,
    /// A film in pixels.
    Pixels,
    /// A film of one bounce, in pixels.
    OneBounce,
    /// A film of ten bounces, in metres.
    TenBounces,
}

impl Kind {
    pub(crate) const ALL: [Self; 9] = [
        Self::Heights,
        Self::Drops,
        Self::Times,
        Self::Intervals,
        Self::Both,
        Self::Film,
        Self::Pixels,
        Self::OneBounce,
        Self::TenBounces,
    ];

    /// The faults that this kind of record can have.
    pub(crate) fn faults(self) -> &'static [Fault] {
        use Fault::{
            Centimetres, Clock, Drag, Echo, Frames, Lens, Lost, Noisy, Scale, Sound, Speed, Stated, Wild, Zero,
        };
        match self {
            Self::Heights => &[Sound, Stated, Noisy, Centimetres, Lost, Zero, Drag, Speed, Wild],
            Self::Drops => &[Sound, Stated, Noisy, Centimetres, Zero, Drag, Speed, Wild],
            Self::Times | Self::Intervals => &[Sound, Stated, Noisy, Frames, Echo, Lost, Drag, Speed],
            Self::Both => &[Sound, Stated, Noisy, Frames, Centimetres, Lost, Zero, Clock, Scale, Drag, Speed],
            Self::Film | Self::Pixels | Self::OneBounce | Self::TenBounces => {
                &[Sound, Noisy, Wild, Lens, Scale, Clock, Drag, Speed]
            }
        }
    }
}

/// What is wrong with a record, one thing at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    /// Nothing.
    Sound,
    /// Nothing, and all is stated: the errors of reading, that the zero is right, that there is no
    /// air.
    Stated,
    /// Readings scatter three to six times more.
    Noisy,
    /// Heights are rounded to whole centimetres.
    Centimetres,
    /// Times are rounded to frames of 1/30 s.
    Frames,
    /// Some contacts are heard twice.
    Echo,
    /// A bounce is missing from the table.
    Lost,
    /// One reading in twelve is wild.
    Wild,
    /// Heights are read 3 to 6 cm too high.
    Zero,
    /// The clock, or the frame rate, is wrong by 5 to 20 %.
    Clock,
    /// Lengths are wrong by 5 to 20 %.
    Scale,
    /// The lens bends the picture: by 3 to 8 % at its edge.
    Lens,
    /// The ball is light: k = 0.10 to 0.14 1/m.
    Drag,
    /// The COR falls with the speed of impact by 0.01 to 0.03 for every m/s.
    Speed,
}

/// One planted experiment.
pub(crate) struct Planted {
    pub(crate) text: String,
    pub(crate) options: ReadOptions,
    pub(crate) fit: Fit,
    /// The least and greatest COR of the impacts that were recorded.
    pub(crate) truth: [f64; 2],
}

fn between(noise: &mut Noise, low: f64, high: f64) -> f64 {
    low + (high - low) * noise.uniform()
}

/// A record of the kind with the fault, by number: the same number gives the same record.
pub(crate) fn plant(kind: Kind, fault: Fault, number: u64) -> Planted {
    let mut noise = Noise(number.wrapping_mul(0x9E37_79B9) ^ ((kind as u64) << 32) ^ ((fault as u64) << 40));
    let n = &mut noise;
    let slope = if fault == Fault::Speed { between(n, 0.01, 0.03) } else { 0.0 };
    // Balls that people drop weigh 24 g and more: a squash ball has 0.016 1/m, a golf ball 0.006.
    let drag = match fault {
        Fault::Drag => between(n, 0.10, 0.14),
        Fault::Stated => 0.0,
        _ => between(n, 0.0, 0.016),
    };
    let e = if fault == Fault::Drag { between(n, 0.8, 0.93) } else { between(n, 0.45, 0.9) };
    let ball = Ball { drop: between(n, 0.6, 1.8), cor: (e + 3.0 * slope, slope), drag };
    match kind {
        Kind::Heights => heights(ball, fault, n),
        Kind::Drops => drops(ball, fault, n),
        Kind::Times => times(ball, fault, n, false),
        Kind::Intervals => times(ball, fault, n, true),
        Kind::Both => both(ball, fault, n),
        Kind::Film => film(ball, fault, n, Kind::Film),
        Kind::Pixels | Kind::OneBounce | Kind::TenBounces => film(ball, fault, n, kind),
    }
}

/// How a height is read: the truth, the zero, the scale, the scatter, the rounding.
struct Ruler {
    zero: f64,
    scale: f64,
    sigma: f64,
    step: f64,
}

impl Ruler {
    fn of(fault: Fault, noise: &mut Noise) -> Self {
        let sigma = between(noise, 0.002, 0.008);
        let sign = if noise.uniform() < 0.5 { -1.0 } else { 1.0 };
        Self {
            zero: if fault == Fault::Zero { between(noise, 0.03, 0.06) } else { 0.0 },
            scale: if fault == Fault::Scale { 1.0 + sign * between(noise, 0.05, 0.2) } else { 1.0 },
            sigma: if fault == Fault::Noisy { sigma * between(noise, 3.0, 6.0) } else { sigma },
            step: if fault == Fault::Centimetres { 0.01 } else { 0.001 },
        }
    }

    fn read(&self, height: f64, fault: Fault, noise: &mut Noise) -> f64 {
        let wild = fault == Fault::Wild && noise.uniform() < 1.0 / 12.0;
        let off = if wild { between(noise, 0.1, 0.3) } else { 0.0 };
        let read = self.scale * (height + self.zero) + noise.normal(self.sigma) + off;
        ((read / self.step).round() * self.step).max(self.step)
    }

    /// What is known beside the table: nothing, or all of it.
    fn stated(&self, fault: Fault, fit: Fit) -> Fit {
        if fault == Fault::Stated {
            fit.sigma_height(self.sigma).sigma_zero(0.0).sigma_scale(0.0).drag(0.0)
        } else {
            fit
        }
    }
}

fn heights(ball: Ball, fault: Fault, noise: &mut Noise) -> Planted {
    let ruler = Ruler::of(fault, noise);
    let trials = if noise.uniform() < 0.4 { 3 } else { 1 };
    // Of two heights nothing tells that one between them is missing: a table that can show it has
    // three.
    let bounces = if fault == Fault::Lost { 3 } else { 2 } + (5.0 * noise.uniform()) as usize;
    let flights = ball.flights(0.0, bounces);
    let mut text = "trial,bounce,height_cm\n".to_owned();
    for trial in 0..trials {
        let lost =
            if fault == Fault::Lost { 1 + (noise.uniform() * (bounces - 1) as f64) as usize } else { usize::MAX };
        let kept = flights.iter().enumerate().filter(|(b, _)| *b != lost);
        for (place, (_, flight)) in kept.enumerate() {
            let height = ruler.read(flight.apex.1, fault, noise);
            text += &format!("{trial},{place},{:.2}\n", 100.0 * height);
        }
    }
    Planted { text, options: ReadOptions::default(), fit: ruler.stated(fault, Fit::new()), truth: ball.cors(bounces) }
}

fn drops(ball: Ball, fault: Fault, noise: &mut Noise) -> Planted {
    let ruler = Ruler::of(fault, noise);
    let rows = 4 + (7.0 * noise.uniform()) as usize;
    let levels = if noise.uniform() < 0.5 { 1 } else { 3 };
    let mut truth = [f64::INFINITY, 0.0f64];
    let mut text = "drop_cm,rebound_cm\n".to_owned();
    for row in 0..rows {
        let ball = Ball { drop: ball.drop * (1.0 - 0.25 * (row % levels) as f64), ..ball };
        let flight = ball.flights(0.0, 1)[1];
        let ends = ball.cors(1);
        truth = [truth[0].min(ends[0]), truth[1].max(ends[1])];
        let steady = if fault == Fault::Wild { Fault::Sound } else { fault };
        let (drop, rebound) = (ruler.read(ball.drop, steady, noise), ruler.read(flight.apex.1, fault, noise));
        text += &format!("{:.2},{:.2}\n", 100.0 * drop, 100.0 * rebound);
    }
    Planted { text, options: ReadOptions::default(), fit: ruler.stated(fault, Fit::new()), truth }
}

fn times(ball: Ball, fault: Fault, noise: &mut Noise, intervals: bool) -> Planted {
    let sigma = between(noise, 0.0005, 0.003) * if fault == Fault::Noisy { between(noise, 3.0, 6.0) } else { 1.0 };
    let trials = if noise.uniform() < 0.4 { 3 } else { 1 };
    let bounces = 5 + (4.0 * noise.uniform()) as usize;
    let flights = ball.flights(0.0, bounces);
    let mut text = if intervals { "trial,bounce,interval_s\n" } else { "trial,bounce,time_s\n" }.to_owned();
    for trial in 0..trials {
        let lost =
            if fault == Fault::Lost { 1 + (noise.uniform() * (bounces - 2) as f64) as usize } else { usize::MAX };
        let begin = noise.uniform();
        let mut read = Vec::new();
        for (b, flight) in flights[1..].iter().enumerate().filter(|(b, _)| *b != lost) {
            let time = begin + flight.start + noise.normal(sigma);
            read.push(if fault == Fault::Frames { (30.0 * time).round() / 30.0 } else { time });
            if fault == Fault::Echo && noise.uniform() < 0.3 && b < 4 {
                read.push(time + between(noise, 0.02, 0.06));
            }
        }
        if intervals {
            read = read.windows(2).map(|w| w[1] - w[0]).collect();
        }
        for (place, time) in read.iter().enumerate() {
            text += &format!("{trial},{},{time:.4}\n", place + 1);
        }
    }
    let fit = if fault == Fault::Stated { Fit::new().sigma_time(sigma).drag(0.0) } else { Fit::new() };
    Planted { text, options: ReadOptions::default(), fit, truth: ball.cors(bounces) }
}

fn both(ball: Ball, fault: Fault, noise: &mut Noise) -> Planted {
    let ruler = Ruler::of(fault, noise);
    let sigma = between(noise, 0.001, 0.005) * if fault == Fault::Noisy { between(noise, 3.0, 6.0) } else { 1.0 };
    let sign = if noise.uniform() < 0.5 { -1.0 } else { 1.0 };
    let clock = if fault == Fault::Clock { 1.0 + sign * between(noise, 0.05, 0.2) } else { 1.0 };
    let bounces = 3 + (3.0 * noise.uniform()) as usize;
    let flights = ball.flights(0.0, bounces);
    let lost = if fault == Fault::Lost { 1 + (noise.uniform() * (bounces - 1) as f64) as usize } else { usize::MAX };
    let drop = ruler.read(ball.drop, fault, noise);
    let mut text = format!("event,time_s,height_cm\nrelease,0,{:.2}\n", 100.0 * drop);
    for (_, flight) in flights.iter().enumerate().skip(1).filter(|(b, _)| *b != lost) {
        let time = clock * flight.start + noise.normal(sigma);
        let time = if fault == Fault::Frames { (30.0 * time).round() / 30.0 } else { time };
        let height = ruler.read(flight.apex.1, fault, noise);
        text += &format!("contact,{time:.4},\napex,,{:.2}\n", 100.0 * height);
    }
    let mut fit = ruler.stated(fault, Fit::new()).gravity(G);
    if fault == Fault::Stated {
        fit = fit.sigma_time(sigma);
    }
    Planted { text, options: ReadOptions::default(), fit, truth: ball.cors(bounces) }
}

fn film(ball: Ball, fault: Fault, noise: &mut Noise, kind: Kind) -> Planted {
    let bounces = match kind {
        Kind::OneBounce => 1,
        Kind::TenBounces => 10,
        _ => 2 + (4.0 * noise.uniform()) as usize,
    };
    let ball = if kind == Kind::TenBounces { Ball { cor: (ball.cor.0.max(0.75), ball.cor.1), ..ball } } else { ball };
    let rate = [30.0, 60.0, 120.0, 240.0][(4.0 * noise.uniform()) as usize % 4];
    let rate = if kind == Kind::TenBounces { f64::max(rate, 60.0) } else { rate };
    let release = between(noise, 0.0, 0.3);
    let flights = ball.flights(release, bounces);
    let sigma = between(noise, 0.0005, 0.003) * if fault == Fault::Noisy { between(noise, 3.0, 6.0) } else { 1.0 };
    let sign = if noise.uniform() < 0.5 { -1.0 } else { 1.0 };
    let wrong = 1.0 + sign * between(noise, 0.05, 0.2);
    let (clock, scale) = match fault {
        Fault::Clock => (wrong, 1.0),
        Fault::Scale => (1.0, wrong),
        _ => (1.0, 1.0),
    };
    // The middle of the picture is at half the drop; its edge a little above.
    let (middle, edge) = (0.5 * ball.drop, 0.6 * ball.drop);
    let bend = if fault == Fault::Lens { sign * between(noise, 0.03, 0.08) } else { 0.0 };
    let last = flights.last().map_or(0.0, |f| f.start + 0.85 * (f.end - f.start));
    let pixels = matches!(kind, Kind::Pixels | Kind::OneBounce);
    let mut text = if pixels { "time_s,y_px\n" } else { "time_s,height_m\n" }.to_owned();
    let per_metre = between(noise, 400.0, 900.0);
    for frame in 0..(rate * last) as usize {
        let t = frame as f64 / rate;
        let y = (ball.height(&flights, t) - middle) / edge;
        let bent = middle + edge * y * (1.0 + bend * y * y);
        let wild = if fault == Fault::Wild && noise.uniform() < 1.0 / 12.0 { between(noise, -0.4, 0.4) } else { 0.0 };
        let read = scale * (bent + noise.normal(sigma) + wild);
        text += &if pixels {
            format!("{:.5},{:.1}\n", clock * t, 1000.0 - per_metre * read)
        } else {
            format!("{:.5},{read:.4}\n", clock * t)
        };
    }
    Planted { text, options: ReadOptions::default(), fit: Fit::new(), truth: ball.cors(bounces) }
}
