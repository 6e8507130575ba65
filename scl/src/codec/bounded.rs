//! Limits on what serde decodes, for formats whose library has none.
//!
//! Without them, a frame of a few kilobytes could nest so deep that the stack overflows and the process dies, or
//! announce 2^60 elements that occupy no bytes and keep the process busy forever. Moreover, serde allocates up to 1 MiB
//! for announced elements on each level: a few bytes per level would take 128 MiB. So each serde interface is wrapped,
//! each wrapper wraps the values that it passes on, and the calls that enter a level or move to the next element are
//! counted.
//!
//! An element of one byte can also decode to a struct of thousands of bytes, all of whose fields have their default.
//! The wrappers know the types of the decoded values, and count their sizes.

use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error, MapAccess, SeqAccess, VariantAccess, Visitor,
};
use std::cell::Cell;
use std::fmt;

/// Maximum depth of nested sequences, maps, enums and `Some`.
const LEVELS: usize = 128;
/// Maximum number of elements that occupy no bytes. Every other element occupies at least one byte of the frame.
const EMPTY_ELEMENTS: usize = 4096;
/// Depth up to which memory is allocated for announced elements.
const ALLOCATING_LEVELS: usize = 16;
/// How much memory lists, maps and structs may take, in multiples of the frame's length.
const FACTOR: usize = 64;
/// Memory that even a short frame may take, in bytes.
const LEAST_MEMORY: usize = 16 << 20;
/// A list that grows has room for up to twice as many elements as it holds. So has a map, and while it grows, its
/// smaller predecessor takes memory as well.
const LIST_ROOM: usize = 2;
const MAP_ROOM: usize = 5;

/// Decodes a value from a frame of `length` bytes.
pub(super) fn decode<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    input: D,
    length: usize,
    floats: Floats,
) -> Result<T, D::Error> {
    let elements = length.saturating_add(EMPTY_ELEMENTS);
    let memory = length.saturating_mul(FACTOR).max(LEAST_MEMORY);
    let [levels, elements, memory, allocatable] = [LEVELS, elements, memory, length].map(Cell::new);
    T::deserialize(Bounded { inner: input, bounds: &Bounds { levels, elements, memory, allocatable, floats } })
}

/// How floats are decoded.
#[derive(Clone, Copy, PartialEq)]
#[allow(dead_code, reason = "each format uses one of them, and formats can be left out")]
pub(super) enum Floats {
    /// As the format's library does it.
    OfTheirWidth,
    /// From numbers of any type. For self-describing formats whose library insists on the type's width: Python and
    /// JavaScript have floats of one width only, and send whole numbers as integers.
    OfAnyNumber,
}

/// What remains of the limits.
struct Bounds {
    levels: Cell<usize>,
    elements: Cell<usize>,
    memory: Cell<usize>,
    /// The number of elements for which memory may still be allocated in advance; the total is the frame's length.
    allocatable: Cell<usize>,
    floats: Floats,
}

impl Bounds {
    /// Enters a level of nesting, and counts the memory of a `T`, which may be in a box.
    fn enter<T, E: Error>(&self) -> Result<Level<'_>, E> {
        self.count_memory(size_of::<T>())?;
        let left = self.levels.get().checked_sub(1);
        self.levels.set(left.ok_or_else(|| E::custom(format_args!("nested deeper than {LEVELS} levels")))?);
        Ok(Level(&self.levels))
    }

    fn count_memory<E: Error>(&self, bytes: usize) -> Result<(), E> {
        let left = self.memory.get().checked_sub(bytes);
        let limit = LEAST_MEMORY >> 20;
        self.memory.set(left.ok_or_else(|| {
            E::custom(format_args!(
                "takes more memory than {FACTOR} times the frame and {limit} MiB; send smaller messages"
            ))
        })?);
        Ok(())
    }

    fn count_element<E: Error>(&self) -> Result<(), E> {
        let left = self.elements.get().checked_sub(1);
        self.elements.set(left.ok_or_else(|| E::custom("announces more elements than the frame can hold"))?);
        Ok(())
    }

    fn allocate(&self, announced: usize) -> usize {
        // serde preallocates up to 1 MiB for each open list, so only the outer levels may preallocate.
        if LEVELS - self.levels.get() > ALLOCATING_LEVELS {
            return 0;
        }
        let allocated = announced.min(self.allocatable.get());
        self.allocatable.set(self.allocatable.get() - allocated);
        allocated
    }
}

/// A level of nesting, left when this is dropped.
struct Level<'b>(&'b Cell<usize>);

impl Drop for Level<'_> {
    fn drop(&mut self) {
        self.0.set(self.0.get() + 1);
    }
}

/// Wraps a deserializer, a seed, or the access to an enum.
struct Bounded<'b, I> {
    inner: I,
    bounds: &'b Bounds,
}

/// Wraps a visitor, or the access to the elements that it visits; `announced` if their number comes from the frame.
struct Counted<'b, I> {
    inner: I,
    bounds: &'b Bounds,
    announced: bool,
}

macro_rules! forward {
    ($($method:ident($($argument:ident: $type:ty),*) $announced:literal)*) => {$(
        fn $method<V: Visitor<'de>>(self, $($argument: $type,)* visitor: V) -> Result<V::Value, D::Error> {
            self.inner.$method($($argument,)* Counted { inner: visitor, bounds: self.bounds, announced: $announced })
        }
    )*};
}

impl<'de, D: Deserializer<'de>> Deserializer<'de> for Bounded<'_, D> {
    type Error = D::Error;

    forward! {
        deserialize_any() true deserialize_seq() true deserialize_map() true deserialize_ignored_any() true
        deserialize_bool() false deserialize_char() false
        deserialize_i8() false deserialize_i16() false deserialize_i32() false deserialize_i64() false
        deserialize_u8() false deserialize_u16() false deserialize_u32() false deserialize_u64() false
        deserialize_i128() false deserialize_u128() false
        deserialize_str() false deserialize_string() false deserialize_bytes() false deserialize_byte_buf() false
        deserialize_option() false deserialize_unit() false deserialize_identifier() false
        deserialize_unit_struct(name: &'static str) false
        deserialize_newtype_struct(name: &'static str) false
        deserialize_tuple(length: usize) false
        deserialize_tuple_struct(name: &'static str, length: usize) false
        deserialize_struct(name: &'static str, fields: &'static [&'static str]) false
        deserialize_enum(name: &'static str, variants: &'static [&'static str]) false
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        if self.bounds.floats == Floats::OfAnyNumber {
            return self.deserialize_any(visitor);
        }
        self.inner.deserialize_f32(Counted { inner: visitor, bounds: self.bounds, announced: false })
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        if self.bounds.floats == Floats::OfAnyNumber {
            return self.deserialize_any(visitor);
        }
        self.inner.deserialize_f64(Counted { inner: visitor, bounds: self.bounds, announced: false })
    }

    fn is_human_readable(&self) -> bool {
        self.inner.is_human_readable()
    }
}

impl<'de, V: Visitor<'de>> Visitor<'de> for Counted<'_, V> {
    type Value = V::Value;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.inner.expecting(formatter)
    }

    visit_plain! {
        visit_bool(v: bool) visit_char(v: char) visit_f32(v: f32) visit_f64(v: f64) visit_i8(v: i8)
        visit_i16(v: i16) visit_i32(v: i32) visit_i64(v: i64) visit_i128(v: i128) visit_u8(v: u8)
        visit_u16(v: u16) visit_u32(v: u32) visit_u64(v: u64) visit_u128(v: u128) visit_str(v: &str)
        visit_borrowed_str(v: &'de str) visit_string(v: String) visit_bytes(v: &[u8])
        visit_borrowed_bytes(v: &'de [u8]) visit_byte_buf(v: Vec<u8>) visit_none() visit_unit()
    }

    fn visit_newtype_struct<D: Deserializer<'de>>(self, content: D) -> Result<V::Value, D::Error> {
        self.inner.visit_newtype_struct(Bounded { inner: content, bounds: self.bounds })
    }

    fn visit_some<D: Deserializer<'de>>(self, content: D) -> Result<V::Value, D::Error> {
        let _level = self.bounds.enter::<(), _>()?;
        self.inner.visit_some(Bounded { inner: content, bounds: self.bounds })
    }

    fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<V::Value, A::Error> {
        let _level = self.bounds.enter::<V::Value, _>()?;
        self.inner.visit_seq(Counted { inner: elements, bounds: self.bounds, announced: self.announced })
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<V::Value, A::Error> {
        let _level = self.bounds.enter::<V::Value, _>()?;
        self.inner.visit_map(Counted { inner: entries, bounds: self.bounds, announced: self.announced })
    }

    fn visit_enum<A: EnumAccess<'de>>(self, variant: A) -> Result<V::Value, A::Error> {
        let _level = self.bounds.enter::<V::Value, _>()?;
        self.inner.visit_enum(Bounded { inner: variant, bounds: self.bounds })
    }
}

impl<I> Counted<'_, I> {
    fn count<E: Error>(&self, memory: usize) -> Result<(), E> {
        if !self.announced {
            return Ok(());
        }
        self.bounds.count_element()?;
        self.bounds.count_memory(memory)
    }

    fn allocated(&self, hint: Option<usize>) -> Option<usize> {
        if self.announced { hint.map(|announced| self.bounds.allocate(announced)) } else { hint }
    }
}

impl<'de, A: SeqAccess<'de>> SeqAccess<'de> for Counted<'_, A> {
    type Error = A::Error;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, A::Error> {
        let element = self.inner.next_element_seed(Bounded { inner: seed, bounds: self.bounds })?;
        self.count(LIST_ROOM * size_of::<S::Value>())?;
        Ok(element)
    }

    fn size_hint(&self) -> Option<usize> {
        self.allocated(self.inner.size_hint())
    }
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for Counted<'_, A> {
    type Error = A::Error;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, A::Error> {
        let key = self.inner.next_key_seed(Bounded { inner: seed, bounds: self.bounds })?;
        self.count(MAP_ROOM * size_of::<S::Value>())?;
        Ok(key)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, A::Error> {
        if self.announced {
            self.bounds.count_memory(MAP_ROOM * size_of::<S::Value>())?;
        }
        self.inner.next_value_seed(Bounded { inner: seed, bounds: self.bounds })
    }

    fn size_hint(&self) -> Option<usize> {
        self.allocated(self.inner.size_hint())
    }
}

impl<'de, S: DeserializeSeed<'de>> DeserializeSeed<'de> for Bounded<'_, S> {
    type Value = S::Value;

    fn deserialize<D: Deserializer<'de>>(self, input: D) -> Result<S::Value, D::Error> {
        self.inner.deserialize(Bounded { inner: input, bounds: self.bounds })
    }
}

impl<'de, 'b, A: EnumAccess<'de>> EnumAccess<'de> for Bounded<'b, A> {
    type Error = A::Error;
    type Variant = Bounded<'b, A::Variant>;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Self::Variant), A::Error> {
        let (name, content) = self.inner.variant_seed(Bounded { inner: seed, bounds: self.bounds })?;
        Ok((name, Bounded { inner: content, bounds: self.bounds }))
    }
}

impl<'de, A: VariantAccess<'de>> VariantAccess<'de> for Bounded<'_, A> {
    type Error = A::Error;

    fn unit_variant(self) -> Result<(), A::Error> {
        self.inner.unit_variant()
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, A::Error> {
        self.inner.newtype_variant_seed(Bounded { inner: seed, bounds: self.bounds })
    }

    fn tuple_variant<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, A::Error> {
        self.inner.tuple_variant(length, Counted { inner: visitor, bounds: self.bounds, announced: false })
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, A::Error> {
        self.inner.struct_variant(fields, Counted { inner: visitor, bounds: self.bounds, announced: false })
    }
}
