//! In which unit a file has its lengths, and which of its axes is up.

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unit {
    /// m.
    #[default]
    Metre,
    /// cm.
    Centimetre,
    /// mm.
    Millimetre,
    /// in, 25.4 mm.
    Inch,
    /// ft, 304.8 mm.
    Foot,
}

impl Unit {
    /// All units.
    pub const ALL: [Self; 5] = [Self::Metre, Self::Centimetre, Self::Millimetre, Self::Inch, Self::Foot];

    /// The symbol of the unit.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Inch => "in",
            Self::Foot => "ft",
        }
    }

    /// A sentence about the unit.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Metre => "Metres",
            Self::Centimetre => "Centimetres",
            Self::Millimetre => "Millimetres",
            Self::Inch => "Inches of 25.4 mm",
            Self::Foot => "Feet of 12 inches",
        }
    }

    /// The length of the unit, in m.
    ///
    /// ```
    /// use saltus_motion::Unit;
    /// assert!((12.0 * Unit::Inch.metres() - Unit::Foot.metres()).abs() < 1e-15);
    /// ```
    #[must_use]
    pub const fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 0.01,
            Self::Millimetre => 0.001,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
        }
    }

    /// The number of units in a metre: of those that are decimal a whole number.
    pub(crate) const fn per_metre(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 100.0,
            Self::Millimetre => 1000.0,
            Self::Inch | Self::Foot => 1.0 / self.metres(),
        }
    }
}

/// The axis that is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Up {
    /// The y axis; z is then towards the viewer: (x, y, up) is written as (x, up, -y).
    Y,
    /// The z axis; y is then away from the viewer: (x, y, up) is written as it is.
    Z,
}

impl Up {
    /// Both axes.
    pub const ALL: [Self; 2] = [Self::Y, Self::Z];

    /// The letter of the axis.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Y => "y",
            Self::Z => "z",
        }
    }

    /// A sentence about the axis.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Y => "As in Maya, glTF and most of USD",
            Self::Z => "As in Blender and most of CAD",
        }
    }
}

/// The unit and the axis of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Space {
    /// The unit of its lengths.
    pub unit: Unit,
    /// The axis that is up; without it the format's own.
    pub up: Option<Up>,
}
