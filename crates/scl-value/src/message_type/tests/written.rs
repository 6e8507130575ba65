//! What a user has written is what is sent.

use super::*;

/// What a text becomes as a message, or why not.
fn sent(name: Option<&str>, codec: &str, text: &str) -> String {
    let described = name.filter(|name| name.starts_with("rover."));
    let messages =
        described.map_or_else(|| MessageType::new(name, codec, None).unwrap(), |name| message_type(name, codec));
    match messages.encode(&read_yaml(text).unwrap()) {
        Ok(bytes) if messages.is_opaque() => bytes.iter().map(|byte| format!("{byte:02x}")).collect(),
        Ok(bytes) => to_json(&messages.decode(&bytes).unwrap()),
        Err(error) => {
            let help = error.help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default();
            format!("{error}{help}")
        }
    }
}

/// All cases, with what is sent of each.
fn all_sent(name: Option<&str>, codec: &str, texts: &[&str]) -> String {
    texts.iter().map(|text| format!("{text} -> {}\n", sent(name, codec, text))).collect()
}

/// The same for a measurement, without the fields that have their defaults.
fn fields_sent(text: &str) -> String {
    let told = sent(Some("rover.Measurement"), "protobuf", text);
    let read = |json: &str| serde_json::from_str::<serde_json::Map<String, serde_json::Value>>(json);
    let defaults = read(&sent(Some("rover.Measurement"), "protobuf", "{}")).unwrap();
    let Ok(mut fields) = read(&told) else { return told };
    fields.retain(|name, value| defaults.get(name) != Some(value));
    serde_json::to_string(&fields).unwrap()
}

#[test]
fn bytes_are_taken_as_they_are_written() {
    let texts = [
        "{hex: 0x10}",
        "{hex: 0x1F}",
        "{hex: 0X1f}",
        "{hex: 10}",
        "{hex: 1e30}",
        "{hex: 0010}",
        "{hex: 0b11}",
        "{hex: 123456789012345678901234567890123456789012}",
        "{hex: 0x01 0x02 ff}",
        "{hex: 0o17}",
        "{hex: +5}",
        "{hex: 1.5}",
        "{hex: 0x1 0x2}",
        "{hex: 0x}",
        "{hex: ~}",
        "{hex: True}",
        "{text: 0x10}",
        "{text: 1.10}",
        "{text: True}",
        "{text: ~}",
        "{text: 017}",
    ];
    expect![[r#"
        {hex: 0x10} -> 10
        {hex: 0x1F} -> 1f
        {hex: 0X1f} -> 1f
        {hex: 10} -> 10
        {hex: 1e30} -> 1e30
        {hex: 0010} -> 0010
        {hex: 0b11} -> 0b11
        {hex: 123456789012345678901234567890123456789012} -> 123456789012345678901234567890123456789012
        {hex: 0x01 0x02 ff} -> 0102ff
        {hex: 0o17} -> expected pairs of hexadecimal digits, found `0o17` (write `{hex: 01ff}`, `{text: hello}` or `!binary AQL/`)
        {hex: +5} -> expected pairs of hexadecimal digits, found `+5` (write `{hex: 01ff}`, `{text: hello}` or `!binary AQL/`)
        {hex: 1.5} -> expected pairs of hexadecimal digits, found `1.5` (write `{hex: 01ff}`, `{text: hello}` or `!binary AQL/`)
        {hex: 0x1 0x2} -> expected pairs of hexadecimal digits, found `0x1 0x2` (write `{hex: 01ff}`, `{text: hello}` or `!binary AQL/`)
        {hex: 0x} -> expected pairs of hexadecimal digits, found `0x` (write `{hex: 01ff}`, `{text: hello}` or `!binary AQL/`)
        {hex: ~} -> expected bytes (write `{hex: 01ff}`, `{text: hello}` or `!binary AQL/`)
        {hex: True} -> expected pairs of hexadecimal digits, found `True` (write `{hex: 01ff}`, `{text: hello}` or `!binary AQL/`)
        {text: 0x10} -> 30783130
        {text: 1.10} -> 312e3130
        {text: True} -> 54727565
        {text: ~} -> expected bytes (write `{hex: 01ff}`, `{text: hello}` or `!binary AQL/`)
        {text: 017} -> 303137
    "#]].assert_eq(&all_sent(None, "protobuf", &texts));
}

#[test]
fn texts_names_and_keys_are_taken_as_they_are_written() {
    let texts = [
        "{unit: 0x10}",
        "{unit: 1.10}",
        "{unit: True}",
        "{unit: 017}",
        "{raw_data: 0x10}",
        "{counts: {0x10: 1, 1.10: 2, ~: 3, True: 4, 1e3: 5, 017: 6}}",
        "{points: {0x10: {x: 1}}}",
        "{points: {16: {}, 0x10: {}}}",
        "{flags: {True: a}}",
        "{0x10: 1}",
        "{mode: 0x2}",
        "{mode: 02}",
        "{mode: True}",
        "{on: yes}",
        "{on: Off}",
        "{on: 0x1}",
    ];
    let shown: String = texts.iter().map(|text| format!("{text} -> {}\n", fields_sent(text))).collect();
    expect![[r#"
        {unit: 0x10} -> field `unit`: expected a text, found 0x10 (quote it: '0x10')
        {unit: 1.10} -> field `unit`: expected a text, found 1.10 (quote it: '1.10')
        {unit: True} -> field `unit`: expected a text, found True (quote it: 'True')
        {unit: 017} -> {"unit":"017"}
        {raw_data: 0x10} -> field `raw_data`: expected bytes as base64, found 0x10 (as base64, these bytes are 'EA==')
        {counts: {0x10: 1, 1.10: 2, ~: 3, True: 4, 1e3: 5, 017: 6}} -> {"counts":{"017":6,"0x10":1,"1.10":2,"1e3":5,"True":4,"~":3}}
        {points: {0x10: {x: 1}}} -> {"points":{"16":{"x":1.0,"y":0.0}}}
        {points: {16: {}, 0x10: {}}} -> field `points[0x10]`: the key is given twice
        {flags: {True: a}} -> {"flags":{"true":"a"}}
        {0x10: 1} -> message `rover.Measurement` has no field `0x10`
        {mode: 0x2} -> {"mode":"MANUAL"}
        {mode: 02} -> field `mode`: `rover.Mode` has no value `02`
        {mode: True} -> field `mode`: expected a value of `rover.Mode`, found True
        {on: yes} -> field `on`: expected true or false, found the text `yes` (write `true`)
        {on: Off} -> field `on`: expected true or false, found the text `Off` (write `false`)
        {on: 0x1} -> field `on`: expected true or false, found 0x1
    "#]].assert_eq(&shown);
    let texts = [
        "{word: NULL, words: [TRUE, Inf, NULL], by_name: {~: TRUE}}",
        "{word: null}",
        "{words: [null]}",
        "{words: [.inf]}",
        "{maybe: 0x10}",
    ];
    expect![[r#"
        {word: NULL, words: [TRUE, Inf, NULL], by_name: {~: TRUE}} -> {"word":"NULL","words":["TRUE","Inf","NULL"],"by_name":{"~":"TRUE"}}
        {word: null} -> {"word":"NULL","words":[],"by_name":{}}
        {words: [null]} -> field `words[0]`: expected a value of `rover.Word`, found null
        {words: [.inf]} -> field `words[0]`: expected a whole number from -2147483648 to 2147483647 (int32), found .inf
        {maybe: 0x10} -> field `maybe`: expected a text, found 0x10 (quote it: '0x10')
    "#]].assert_eq(&all_sent(Some("rover.Words"), "protobuf", &texts));
}

#[test]
fn whole_numbers_are_never_rounded() {
    let cases = [
        ("i64", "9007199254740993.0"),
        ("i64", "-9223372036854775808"),
        ("i64", "-9223372036854775809"),
        ("u64", "18446744073709551615.0"),
        ("u64", "18446744073709551616"),
        ("u64", "1.8446744073709551615e19"),
        ("i32", "0x10"),
        ("i32", "1e3"),
        ("i32", "1.50"),
        ("i32", "1.00000000000000000001"),
        ("i32", "017"),
        ("i32", "-08"),
        ("position", "00"),
        ("position", "1.10"),
        ("position", "0x10"),
        ("position", "1e999"),
        ("position", ".INF"),
    ];
    let told = cases.map(|(name, number)| format!("{number} -> {}\n", fields_sent(&format!("{{{name}: {number}}}"))));
    expect![[r#"
        9007199254740993.0 -> {"i64":9007199254740993}
        -9223372036854775808 -> {"i64":-9223372036854775808}
        -9223372036854775809 -> field `i64`: expected a whole number from -9223372036854775808 to 9223372036854775807 (int64), found -9223372036854775809
        18446744073709551615.0 -> {"u64":18446744073709551615}
        18446744073709551616 -> field `u64`: expected a whole number from 0 to 18446744073709551615 (uint64), found 18446744073709551616
        1.8446744073709551615e19 -> {"u64":18446744073709551615}
        0x10 -> {"i32":16}
        1e3 -> {"i32":1000}
        1.50 -> field `i32`: expected a whole number from -2147483648 to 2147483647 (int32), found 1.50
        1.00000000000000000001 -> field `i32`: expected a whole number from -2147483648 to 2147483647 (int32), found 1.00000000000000000001
        017 -> field `i32`: expected a whole number from -2147483648 to 2147483647 (int32), found the text `017` (write `17`, or `0o17` for an octal number)
        -08 -> field `i32`: expected a whole number from -2147483648 to 2147483647 (int32), found the text `-08` (write `-8`)
        00 -> field `position`: expected a number (double), found the text `00` (write `0`)
        1.10 -> {"position":1.1}
        0x10 -> {"position":16.0}
        1e999 -> field `position`: expected a number (double), found the text `1e999`
        .INF -> {"position":"Infinity"}
    "#]].assert_eq(&told.concat());
}

#[test]
fn without_a_type_a_scalar_means_what_it_means_to_yaml() {
    let texts = [
        "{a: 0x10, b: 1.10, c: True, d: ~, e: 017, f: 1e3}",
        "{0x10: a, 1.10: b, ~: c}",
        "{a: [1, {b: 18446744073709551616}]}",
        "{a: -9223372036854775809}",
        "{a: 18446744073709551616.0}",
    ];
    expect![[r#"
        {a: 0x10, b: 1.10, c: True, d: ~, e: 017, f: 1e3} -> {"a":16,"b":1.1,"c":true,"d":null,"e":"017","f":1000.0}
        {0x10: a, 1.10: b, ~: c} -> {"0x10":"a","1.10":"b","~":"c"}
        {a: [1, {b: 18446744073709551616}]} -> field `a[1].b`: the number 18446744073709551616 has more than 64 bits (quote it, or write `18446744073709551616.0` for the nearest float)
        {a: -9223372036854775809} -> field `a`: the number -9223372036854775809 has more than 64 bits (quote it, or write `-9223372036854775809.0` for the nearest float)
        {a: 18446744073709551616.0} -> {"a":1.8446744073709552e+19}
    "#]].assert_eq(&all_sent(Some("weather.Temperature"), "json", &texts));
    expect![[r#"
        {a: 0x10, b: 1.10, c: True, d: ~, e: 017, f: 1e3} -> {"a":16,"b":1.1,"c":true,"d":null,"e":"017","f":1000.0}
        {0x10: a, 1.10: b, ~: c} -> {"16":"a","1.1":"b","null":"c"}
        {a: [1, {b: 18446744073709551616}]} -> field `a[1].b`: the number 18446744073709551616 has more than 64 bits (quote it, or write `18446744073709551616.0` for the nearest float)
        {a: -9223372036854775809} -> field `a`: the number -9223372036854775809 has more than 64 bits (quote it, or write `-9223372036854775809.0` for the nearest float)
        {a: 18446744073709551616.0} -> {"a":1.8446744073709552e+19}
    "#]].assert_eq(&all_sent(Some("weather.Temperature"), "cbor", &texts));
}
