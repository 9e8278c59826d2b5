//! Breaks long lines like a formatter: within brackets item by item, or before operators.

/// Maximum line width in columns.
const WIDTH: usize = 110;

/// Operators by precedence, lowest first; a line breaks at the lowest.
const OPERATORS: [&[&str]; 4] = [&["||"], &["&&"], &["+", "-"], &["*", "/"]];

/// Appends a line of code, broken into several if it is too long.
pub(super) fn write_line(out: &mut String, text: &str, indent: usize) {
    let is_short = 4 * indent + text.len() <= WIDTH;
    // The parts of a loop's head stay on one line.
    if is_short || text.starts_with("//") || text.starts_with("for (") {
        return whole(out, text, indent);
    }
    let done = if ends_in_a_call(text) {
        by_items(out, text, indent)
    } else {
        by_operators(out, text, indent) || by_items(out, text, indent)
    };
    if !done {
        whole(out, text, indent);
    }
}

fn whole(out: &mut String, text: &str, indent: usize) {
    // Blank lines are empty.
    let indent = if text.is_empty() { 0 } else { indent };
    for _ in 0..indent {
        out.push_str("    ");
    }
    out.push_str(text);
    out.push('\n');
}

/// Whether a line ends in a call with most of its text; it then breaks within the call.
fn ends_in_a_call(text: &str) -> bool {
    let depths = depths(text);
    let end = text.trim_end_matches([';', ',', ' ', '{']);
    let Some(close) = end.strip_suffix(')').map(str::len) else {
        return false;
    };
    let open = (0..close).rfind(|&at| depths[at] == depths[close] && text.as_bytes()[at] == b'(');
    depths[close] == 0
        && open.is_some_and(|open| {
            2 * open < close && text[..open].ends_with(|c: char| c.is_alphanumeric() || c == '_')
        })
}

/// Breaks a line before operators outside of brackets.
fn by_operators(out: &mut String, text: &str, indent: usize) -> bool {
    let depths = depths(text);
    let places = |operators: &[&str]| -> Vec<usize> {
        let is_operator = |&(at, _): &(usize, &str)| {
            depths[at] == 0
                && operators.iter().any(|operator| {
                    text[at..].strip_prefix(' ').is_some_and(|rest| {
                        rest.strip_prefix(operator)
                            .is_some_and(|rest| rest.starts_with(' '))
                    })
                })
        };
        text.match_indices(' ')
            .filter(is_operator)
            .map(|(at, _)| at)
            .collect()
    };
    let Some(places) = OPERATORS
        .into_iter()
        .map(places)
        .find(|places| !places.is_empty())
    else {
        return false;
    };
    let (text, opens) = match text.strip_suffix(" {") {
        Some(text) => (text, true),
        None => (text, false),
    };
    let (mut from, mut depth) = (0, indent);
    for (number, &place) in places.iter().enumerate() {
        let next = places.get(number + 1).copied().unwrap_or(text.len());
        if 4 * depth + (next - from) > WIDTH {
            write_line(out, text[from..place].trim_start(), depth);
            (from, depth) = (place, indent + 1);
        }
    }
    // If no break is possible, the caller breaks within brackets instead.
    let rest = text[from..].trim_start();
    if from == 0 {
        return false;
    }
    write_line(out, rest, depth);
    if opens {
        whole(out, "{", indent);
    }
    true
}

/// Breaks a line within the longest of its outermost brackets, or within nested ones if they contain only
/// another call.
fn by_items(out: &mut String, text: &str, indent: usize) -> bool {
    let depths = depths(text);
    let groups: Vec<(usize, usize)> = text
        .match_indices(['(', '['])
        .filter_map(|(open, _)| {
            let close = (open + 1..text.len()).find(|&at| depths[at] == depths[open])?;
            Some((open, close))
        })
        .collect();
    let outermost = groups.iter().filter(|&&(open, _)| depths[open] == 0);
    let Some(&(mut open, mut close)) = outermost.max_by_key(|&&(open, close)| close - open) else {
        return false;
    };
    while let Some(&inner) = groups
        .iter()
        .find(|&&inner| is_all_of(text, inner, (open, close)))
    {
        (open, close) = inner;
    }
    let inside = open..close;
    let commas: Vec<usize> = inside
        .filter(|&at| text.as_bytes()[at] == b',' && depths[at] == depths[open] + 1)
        .collect();
    let mut items = Vec::new();
    let mut from = open + 1;
    for comma in &commas {
        items.push(text[from..*comma].trim());
        from = comma + 1;
    }
    items.push(text[from..close].trim());
    if items == [""] {
        return false;
    }
    whole(out, &text[..=open], indent);
    let are_short = items.iter().all(|item| item.len() <= 16);
    let mut line = String::new();
    for item in items {
        if !line.is_empty() && (!are_short || 4 * indent + 4 + line.len() + item.len() + 2 > WIDTH) {
            write_line(out, &line, indent + 1);
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(item);
        if !commas.is_empty() {
            line.push(',');
        }
    }
    write_line(out, &line, indent + 1);
    whole(out, &text[close..], indent);
    true
}

/// Whether a call with the first pair of brackets is the entire content of the second pair.
fn is_all_of(text: &str, (open, close): (usize, usize), (outer, end): (usize, usize)) -> bool {
    let name = text.get(outer + 1..open).unwrap_or("(");
    let is_name = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    is_name && !name.is_empty() && close + 1 == end
}

/// The bracket depth at each byte, including those of types (`array<f32, 3>`); a bracket has the depth
/// outside of it.
fn depths(text: &str) -> Vec<usize> {
    let mut depth = 0_usize;
    let mut types = 0_usize;
    let mut before = ' ';
    let mut depths = Vec::with_capacity(text.len());
    for c in text.chars() {
        let opens_type = c == '<' && before != ' ' && before != '<';
        let closes_type = c == '>' && types > 0;
        if matches!(c, ')' | ']' | '}') && depth > 0 && c != '}' || closes_type {
            depth -= 1;
        }
        depths.extend(std::iter::repeat_n(depth, c.len_utf8()));
        if matches!(c, '(' | '[') || opens_type {
            depth += 1;
        }
        types = if opens_type {
            types + 1
        } else {
            types - usize::from(closes_type)
        };
        before = c;
    }
    depths
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::write_line;

    fn broken(text: &str, expected: &Expect) {
        // The first line keeps `expect!` from removing the indentation.
        let mut out = "{\n".to_owned();
        write_line(&mut out, text, 1);
        expected.assert_eq(&out);
    }

    #[test]
    fn short_lines_stay() {
        broken(
            "let x = f(a, b) + c;",
            &expect![[r"
                {
                    let x = f(a, b) + c;
            "]],
        );
    }

    #[test]
    fn sums_are_broken_before_an_operator() {
        broken(
            "return spheres[emitter].material.color * brdf(hit.material, reflected, direction) * facing * weight(density, other);",
            &expect![[r"
                {
                    return spheres[emitter].material.color * brdf(hit.material, reflected, direction) * facing
                        * weight(density, other);
            "]],
        );
        broken(
            "if first_of_them[index] > second_of_them[index] && third_of_them[index] > fourth_of_them[index] || fifth_of_them {",
            &expect![[r"
                {
                    if first_of_them[index] > second_of_them[index] && third_of_them[index] > fourth_of_them[index]
                        || fifth_of_them
                    {
            "]],
        );
    }

    #[test]
    fn lists_are_broken_item_by_item() {
        broken(
            "return normalize(vec3f(map(p + e.xyy, &which) - map(p - e.xyy, &which), map(p + e.yxy, &which) - map(p - e.yxy, &which)));",
            &expect![[r"
                {
                    return normalize(vec3f(
                        map(p + e.xyy, &which) - map(p - e.xyy, &which),
                        map(p + e.yxy, &which) - map(p - e.yxy, &which),
                    ));
            "]],
        );
        broken(
            "const TABLE = array<f32, 16>(0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0, 1.125, 1.25, 1.375, 1.5, 1.625, 1.75, 1.875, 2.0);",
            &expect![[r"
                {
                    const TABLE = array<f32, 16>(
                        0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0, 1.125, 1.25, 1.375, 1.5, 1.625, 1.75, 1.875, 2.0,
                    );
            "]],
        );
        broken(
            "let n = normalize(k.xyy * scene(p + k.xyy * h) + k.yyx * scene(p + k.yyx * h) + k.yxy * scene(p + k.yxy * h));",
            &expect![[r"
                {
                    let n = normalize(
                        k.xyy * scene(p + k.xyy * h) + k.yyx * scene(p + k.yyx * h) + k.yxy * scene(p + k.yxy * h)
                    );
            "]],
        );
    }
}
