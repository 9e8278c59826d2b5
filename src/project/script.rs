//! Files that describe the user's actions with the mouse and the keyboard over the frames of a run.

use toyproof_diagnostic::{Code, Diagnostics, FileId, Files, nearest};
use toyproof_image::{InputEvent, Script};
use toyproof_toml::{Format, Located, Table};

static FORMAT: Format = Format {
    form_code: Code::ScriptSyntax,
    value_code: Code::ScriptValue,
    aliases: &[],
};

/// The largest number of events of a file: one in each frame of half an hour.
const MAX_EVENTS: usize = 100_000;

/// The names of keys, with the browser's codes.
const NAMED_KEYS: [(&str, u8); 20] = [
    ("backspace", 8),
    ("tab", 9),
    ("enter", 13),
    ("shift", 16),
    ("ctrl", 17),
    ("alt", 18),
    ("escape", 27),
    ("space", 32),
    ("pageup", 33),
    ("pagedown", 34),
    ("end", 35),
    ("home", 36),
    ("left", 37),
    ("up", 38),
    ("right", 39),
    ("down", 40),
    ("insert", 45),
    ("delete", 46),
    ("plus", 187),
    ("minus", 189),
];

/// Parses a script: `[[mouse]]` events with `press`, `move` or `release`, and `[[key]]` events with `press`
/// or `release`, each in a `frame`, from 0.
///
/// # Errors
/// The first syntax error of the TOML, or all other errors.
pub fn parse_script(files: &Files, file: FileId) -> Result<Script, Diagnostics> {
    toyproof_toml::read(&FORMAT, files, file, |document| {
        let mut events = Vec::new();
        let mut add = |table: &mut Table, read: fn(&mut Table) -> Option<InputEvent>| {
            let frame = table.count_or("frame", [0, i32::MAX as u32], 0) as i32;
            if let Some(event) = read(table) {
                if events.len() == MAX_EVENTS {
                    table.reject(
                        table.span(),
                        format!("a script has at most {MAX_EVENTS} events"),
                        "",
                    );
                }
                events.push((frame, event));
            }
        };
        document.tables("mouse", |table| add(table, mouse));
        document.tables("key", |table| add(table, key));
        Script::new(events)
    })
}

/// Reads an event of the mouse.
fn mouse(table: &mut Table) -> Option<InputEvent> {
    let mut event = |key, of: fn([f32; 2]) -> InputEvent| Some(of(position(table, key)?));
    let press = event("press", InputEvent::MousePress);
    let event = press.or_else(|| event("move", InputEvent::MouseMove));
    event.or_else(|| {
        let release = table.optional::<bool>("release").filter(|release| release.value);
        if release.is_none() {
            let help = "add `press = [x, y]`, `move = [x, y]` or `release = true`";
            table.reject(table.span(), "this event of the mouse does nothing", help);
        }
        release.map(|_| InputEvent::MouseRelease)
    })
}

/// Reads a position in pixels.
fn position(table: &mut Table, key: &'static str) -> Option<[f32; 2]> {
    let Located { value, span } = table.optional::<Vec<f64>>(key)?;
    match value[..] {
        [x, y] if x.is_finite() && y.is_finite() => Some([x as f32, y as f32]),
        _ => {
            let located = Located { value, span };
            table.reject_value(
                key,
                &located,
                "must be two finite numbers: [x, y], from the left and from the bottom",
            );
            Some([0.0; 2])
        }
    }
}

/// Reads an event of the keyboard.
fn key(table: &mut Table) -> Option<InputEvent> {
    let mut event = |key, of: fn(u8) -> InputEvent| {
        let name = table.optional::<String>(key)?;
        let code = code(&name.value);
        if code.is_none() {
            let names = NAMED_KEYS.iter().map(|(name, _)| *name);
            let help = match nearest(&name.value.to_lowercase(), names) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => "name a letter, a digit, `space`, `left`, `shift`, …, or the browser's key code, such as \"65\"".to_owned(),
            };
            table.reject(name.span, format!("there is no key \"{}\"", name.value), &help);
        }
        Some(of(code.unwrap_or_default()))
    };
    let press = event("press", InputEvent::KeyPress);
    let event = press.or_else(|| event("release", InputEvent::KeyRelease));
    if event.is_none() {
        let help = "add `press = \"space\"` or `release = \"space\"`";
        table.reject(table.span(), "this event of the keyboard does nothing", help);
    }
    event
}

/// The code of a key: of a name, a letter, a digit alone, or a number.
fn code(name: &str) -> Option<u8> {
    let lower = name.to_lowercase();
    let named = NAMED_KEYS.iter().find(|(known, _)| *known == lower);
    let function = lower
        .strip_prefix('f')
        .and_then(|number| number.parse::<u8>().ok());
    match (lower.as_bytes(), named, function) {
        (_, Some((_, code)), _) => Some(*code),
        ([byte @ (b'a'..=b'z' | b'0'..=b'9')], ..) => Some(byte.to_ascii_uppercase()),
        (_, _, Some(number @ 1..=12)) => Some(111 + number),
        _ => lower.parse().ok(),
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::File;

    use super::*;

    fn parsed(text: &str) -> Result<Script, Vec<String>> {
        let mut files = Files::default();
        let file = files.add(File::new("s.toml", text));
        parse_script(&files, file)
            .map_err(|errors| errors.iter().map(|error| error.message.clone()).collect())
    }

    #[test]
    fn events_of_both_kinds_are_read() {
        let script = parsed(
            "[[mouse]]\nframe = 3\npress = [10, 20.5]\n[[mouse]]\nframe = 5\nrelease = true\n[[key]]\npress = \"Space\"\n",
        )
        .unwrap();
        let expected = [
            (0, InputEvent::KeyPress(32)),
            (3, InputEvent::MousePress([10.0, 20.5])),
            (5, InputEvent::MouseRelease),
        ];
        assert_eq!(script, Script::new(expected.to_vec()));
    }

    #[test]
    fn keys_have_the_codes_of_browsers() {
        let codes = ["a", "Z", "0", "left", "F1", "f12", "65", "Plus", "fn", "256", ""].map(code);
        let expected = [
            Some(65),
            Some(90),
            Some(48),
            Some(37),
            Some(112),
            Some(123),
            Some(65),
            Some(187),
            None,
            None,
            None,
        ];
        assert_eq!(codes, expected);
    }

    #[test]
    fn events_that_do_nothing_and_unknown_keys_are_errors() {
        for (text, message) in [
            ("[[mouse]]\nframe = 1\n", "this event of the mouse does nothing"),
            ("[[key]]\nframe = 1\n", "this event of the keyboard does nothing"),
            ("[[key]]\npress = \"spcae\"\n", "there is no key \"spcae\""),
            ("[[mouse]]\npress = [1]\n", "must be two finite numbers"),
            ("[[mouse]]\npress = [1, 2]\nat = 3\n", "unknown key `at`"),
        ] {
            let errors = parsed(text).unwrap_err();
            assert!(errors[0].contains(message), "{text}: {errors:?}");
        }
    }
}
