//! The values that stand in a scene file: quantities with units, plain numbers, vectors, one thing
//! or a list of it.

#[cfg(test)]
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;

#[cfg(test)]
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

use super::error::Fault;
use saltus_bounce::ParameterError;
use saltus_bounce::units::Quantity;

/// A value and where it stands.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(transparent, bound = "T: Deserialize<'de>")]
pub(super) struct At<T>(Spanned<T>);

impl<T> At<T> {
    pub(super) fn get(&self) -> &T {
        self.0.get_ref()
    }

    pub(super) fn span(&self) -> Range<usize> {
        self.0.span()
    }

    /// That this value is wrong, and why.
    pub(super) fn fault(&self, says: impl fmt::Display) -> Fault {
        Fault::new(self.span(), says)
    }
}

/// The smallest of what is above zero: the product of ten such numbers is not zero yet. Where it is
/// a size, it is far below anything that bounces.
const SMALLEST: f64 = 1e-30;

impl<T: Real> At<T> {
    pub(super) fn real(&self) -> f64 {
        self.get().real()
    }

    pub(super) fn positive(&self, what: &'static str) -> Result<f64, Fault> {
        let value = self.real();
        if value >= SMALLEST {
            Ok(value)
        } else if value > 0.0 {
            Err(self.fault(format!("{value:e} is too small for {what}: give {SMALLEST:e} or more")))
        } else {
            Err(self.fault(format!("{value} is not {what}: give a finite number above zero")))
        }
    }

    pub(super) fn not_negative(&self, what: &'static str) -> Result<f64, Fault> {
        let value = self.real();
        if value >= 0.0 {
            Ok(value)
        } else {
            Err(self.fault(format!("{value} is not {what}: give a finite number, zero or more")))
        }
    }

    /// The value that `law` makes of the number, or the fault at its place.
    pub(super) fn with<U>(&self, law: impl FnOnce(f64) -> Result<U, ParameterError>) -> Result<U, Fault> {
        law(self.real()).map_err(|error| self.fault(error))
    }
}

#[cfg(test)]
impl<T: JsonSchema> JsonSchema for At<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// A value that is one finite number.
pub(super) trait Real {
    fn real(&self) -> f64;
}

/// The quantity of a [`Measure`].
pub(super) trait Dimension {
    const QUANTITY: Quantity;
}

macro_rules! dimensions {
    ($($name:ident)*) => {
        $(
            #[derive(Clone, Copy, Debug)]
            pub(super) enum $name {}
            impl Dimension for $name {
                const QUANTITY: Quantity = Quantity::$name;
            }
        )*
    };
}

dimensions!(Length Time Speed Acceleration Mass Angle AngularSpeed Frequency Rate PerLength PerSpeed Density Viscosity Pressure
    HertzStiffness);

/// A quantity: text with a unit, or a bare number in the SI unit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measure<D>(f64, PhantomData<D>);

impl<D> Real for Measure<D> {
    fn real(&self) -> f64 {
        self.0
    }
}

/// A list of pairs.
pub(super) type Pairs<A, B> = Vec<(A, B)>;

/// A number without a unit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number(pub(super) f64);

impl Real for Number {
    fn real(&self) -> f64 {
        self.0
    }
}

/// Refuses what is given but is not among `keys`, which are those that `kind` takes.
pub(super) fn only<const N: usize>(
    given: [(&str, Option<Range<usize>>); N],
    keys: &[&str],
    kind: &str,
) -> Result<(), Fault> {
    for (key, span) in given {
        if let Some(span) = span.filter(|_| !keys.contains(&key)) {
            let known: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
            let takes = if known.is_empty() { "no keys".to_owned() } else { known.join(", ") };
            return Err(Fault::new(span, format!("`{key}` does not belong to {kind}: that takes {takes}")));
        }
    }
    Ok(())
}

/// The largest number without a unit: a drag coefficient or a curve's shape beyond it leaves no
/// digits to the numbers beside it.
const LARGEST: f64 = 1e12;

fn finite<E: Error>(value: f64) -> Result<f64, E> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(E::custom(format!("{value} is not a finite number: write one that is, such as 0.5")))
    }
}

/// A number without a unit.
fn plain<E: Error>(value: f64) -> Result<f64, E> {
    let beyond = |limit: &str| {
        E::custom(format!("{value:e} is beyond the numbers that can be right: a number without a unit is {limit}"))
    };
    match finite::<E>(value)?.abs() {
        size if size > LARGEST => Err(beyond("at most 1e12 either way")),
        size if size > 0.0 && size < SMALLEST => Err(beyond("zero, or 1e-30 or more either way")),
        _ => Ok(value),
    }
}

#[allow(clippy::cast_precision_loss)] // as every decimal number is rounded
const fn rounded(value: i64) -> f64 {
    value as f64
}

impl<'de, D: Dimension> Deserialize<'de> for Measure<D> {
    fn deserialize<T: Deserializer<'de>>(deserializer: T) -> Result<Self, T::Error> {
        struct Read(Quantity);
        impl Visitor<'_> for Read {
            type Value = f64;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let (a, si) = (self.0.article(), self.0.si());
                write!(f, "{a} {}, such as \"1 {si}\", or a bare number in {si}", self.0)
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<f64, E> {
                self.0.parse(text).map_err(E::custom)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
                self.0.check(finite(value)?).map_err(E::custom)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
                self.0.check(rounded(value)).map_err(E::custom)
            }
        }
        Ok(Self(deserializer.deserialize_any(Read(D::QUANTITY))?, PhantomData))
    }
}

#[cfg(test)]
impl<D: Dimension> JsonSchema for Measure<D> {
    fn schema_name() -> Cow<'static, str> {
        D::QUANTITY.to_string().replace(' ', "-").into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let quantity = D::QUANTITY;
        let units: Vec<&str> = quantity.units().iter().map(|&(name, _)| name).collect();
        json_schema!({
            "description": format!("Text with a unit ({}), or a bare number in {}.", units.join(", "), quantity.si()),
            "type": ["string", "number"],
            "examples": [format!("1 {}", quantity.si())],
        })
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<T: Deserializer<'de>>(deserializer: T) -> Result<Self, T::Error> {
        struct Read;
        impl Visitor<'_> for Read {
            type Value = Number;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, without quotes and without a unit")
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Number, E> {
                plain(value).map(Number)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Number, E> {
                plain(rounded(value)).map(Number)
            }
        }
        deserializer.deserialize_any(Read)
    }
}

#[cfg(test)]
impl JsonSchema for Number {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "number".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "number" })
    }
}

/// A text or a number whose quantity depends on the rest of the file.
#[derive(Clone, Debug)]
pub(super) enum Loose {
    Number(f64),
    Text(String),
}

impl At<Loose> {
    pub(super) fn read(&self, quantity: Quantity) -> Result<f64, Fault> {
        match self.get() {
            Loose::Number(value) => quantity.check(*value).map_err(|error| self.fault(error)),
            Loose::Text(text) => quantity.parse(text).map_err(|error| self.fault(error)),
        }
    }
}

impl<'de> Deserialize<'de> for Loose {
    fn deserialize<T: Deserializer<'de>>(deserializer: T) -> Result<Self, T::Error> {
        struct Read;
        impl Visitor<'_> for Read {
            type Value = Loose;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("text with a unit, or a bare number")
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<Loose, E> {
                Ok(Loose::Text(text.to_owned()))
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Loose, E> {
                finite(value).map(Loose::Number)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Loose, E> {
                Ok(Loose::Number(rounded(value)))
            }
        }
        deserializer.deserialize_any(Read)
    }
}

#[cfg(test)]
impl JsonSchema for Loose {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "quantity".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["string", "number"] })
    }
}

/// One thing, or a list: `[ball]` or several `[[ball]]`, `"1 m"` or `["0 m", "1 m"]`.
#[derive(Clone, Debug)]
pub(super) enum OneOrMany<T> {
    One(T),
    Many(Vec<T>),
}

impl<T> OneOrMany<T> {
    pub(super) fn as_slice(&self) -> &[T] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Many(many) => many,
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OneOrMany<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Read<T> {
            type Value = OneOrMany<T>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("one value or a list of values")
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
                T::deserialize(serde::de::value::StrDeserializer::new(text)).map(OneOrMany::One)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
                T::deserialize(serde::de::value::F64Deserializer::new(value)).map(OneOrMany::One)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                T::deserialize(serde::de::value::I64Deserializer::new(value)).map(OneOrMany::One)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(OneOrMany::One)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
                let mut many = Vec::new();
                while let Some(one) = list.next_element()? {
                    many.push(one);
                }
                Ok(OneOrMany::Many(many))
            }
        }
        deserializer.deserialize_any(Read(PhantomData))
    }
}

#[cfg(test)]
impl<T: JsonSchema> JsonSchema for OneOrMany<T> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("one-or-many-{}", T::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<T>();
        json_schema!({ "anyOf": [one, { "type": "array", "items": one }] })
    }
}

/// A number or a whole table: `0.8` or `{ law = "linear", ... }`; a list of two numbers is a range.
#[derive(Clone, Debug)]
pub(super) enum Short<T> {
    Number(f64),
    Range([f64; 2]),
    Table(Box<T>),
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Short<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Read<T> {
            type Value = Short<T>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number without quotes, a range such as [0.7, 0.8], or a table")
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
                plain(value).map(Short::Number)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                plain(rounded(value)).map(Short::Number)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
                let mut ends = Vec::new();
                while let Some(Number(end)) = list.next_element()? {
                    ends.push(end);
                }
                <[f64; 2]>::try_from(ends).map(Short::Range).map_err(|_| {
                    A::Error::custom("a range has two ends: write the lower and the higher, such as [0.7, 0.8]")
                })
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(|table| Short::Table(Box::new(table)))
            }
        }
        deserializer.deserialize_any(Read(PhantomData))
    }
}

#[cfg(test)]
impl<T: JsonSchema> JsonSchema for Short<T> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("short-{}", T::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let table = generator.subschema_for::<T>();
        let range = json_schema!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 });
        json_schema!({ "anyOf": [{ "type": "number" }, range, table] })
    }
}
