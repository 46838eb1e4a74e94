//! What programs print, and programs that hold readings: frames of data with a number before each
//! row, dumps of a database, lists of a script that go on in the next line.

use super::super::cell::{self, Cell};
use super::super::heading::{Heading, What};
use super::super::units::Unit;
use super::values::{LIST, listed_values};

/// A frame of data as a console prints it, with tabs between its cells: below a line of names rows
/// that are counted from 0 or 1 and hold a word for each name. A cell that single blanks part from
/// the one before it is one all the same. `None` where there is none.
pub(in crate::read) fn indexed(text: &str) -> Option<String> {
    let lines: Vec<&str> = text.lines().collect();
    let words = |n: usize| lines[n].split_whitespace().collect::<Vec<_>>();
    let counted = |n: usize, count: usize, width: usize| {
        let row = words(n);
        row.len() == width && row[0].parse() == Ok(count)
    };
    let begins = |n: &usize| {
        let names = words(*n);
        let width = names.len() + 1;
        let number = |name: &&str| matches!(cell::read(name, false), Cell::Number(_));
        let cells = !lines[*n].contains(['\t', ',', ';', '|']);
        let rows =
            |from: usize| (0..ROWS).all(|row| n + 1 + row < lines.len() && counted(n + 1 + row, from + row, width));
        (cells && names.len() > 1 && !names.iter().any(number)).then(|| (0..2).find(|from| rows(*from))).flatten()
    };
    let (head, from) = (0..lines.len()).find_map(|n| Some((n, begins(&n)?)))?;
    let width = words(head).len() + 1;
    let rows = (0..lines.len() - head - 1).take_while(|row| counted(head + 1 + row, from + row, width)).count();
    // What else is printed is no row of it; what a console is asked, and what it answers to more
    // that it is asked below, says nothing of it.
    let prompts = [">", "In ["];
    let asked = |n: usize| prompts.iter().any(|mark| lines[n].trim_start_matches(['#', ' ']).starts_with(mark));
    let after = (head + rows..lines.len()).find(|n| asked(*n)).unwrap_or(lines.len());
    let spelt = |n: usize| match n {
        n if n >= after => String::new(),
        n if n == head => format!("\t{}", words(n).join("\t")),
        n if n > head && n <= head + rows => {
            // Where nothing was read.
            let read = |word: &str| if cell::read(word, false) == Cell::Lost { String::new() } else { word.to_owned() };
            words(n).into_iter().map(read).collect::<Vec<_>>().join("\t")
        }
        n if n < head || lines[n].trim().is_empty() || lines[n].starts_with('#') => lines[n].to_owned(),
        n => format!("#{}", lines[n]),
    };
    Some((0..lines.len()).map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// So many rows that are counted are no chance.
const ROWS: usize = 3;

/// The rows that a dump of a database inserts, below the names that it creates the table with, or
/// inserts them by; `None` where there are none, or they are of several tables. A line stays a
/// line.
pub(in crate::read) fn dumped(text: &str) -> Option<String> {
    let upper = text.to_ascii_uppercase();
    if upper.len() != text.len() || !upper.contains("INSERT INTO") || !upper.contains("VALUES") {
        return None;
    }
    let (mut names, mut table): (Vec<String>, Option<String>) = (Vec::new(), None);
    let (mut found, mut begun, mut inside, mut created) = (String::new(), false, false, String::new());
    for line in text.lines() {
        let line = line.trim();
        let upper = line.to_ascii_uppercase();
        let mut rows = Vec::new();
        if let Some(remark) = line.strip_prefix("--") {
            found.push('#');
            found.push_str(remark);
        } else if upper.starts_with("CREATE TABLE") || !created.is_empty() {
            created.push_str(line);
            created.push(' ');
            if line.ends_with(';') {
                let columns = created.find('(').zip(created.rfind(')')).map(|(from, to)| &created[from + 1..to])?;
                let named =
                    cells(columns).into_iter().filter_map(|column| Some(bare(column.split_whitespace().next()?)));
                let column = |name: &String| !CONSTRAINTS.contains(&name.to_ascii_uppercase().as_str());
                names = named.filter(column).collect();
                created.clear();
            }
        } else if upper.starts_with("INSERT INTO") || inside {
            let mut rest = line;
            if upper.starts_with("INSERT INTO") {
                let at = upper.find("VALUES").unwrap_or(line.len());
                let head = line["INSERT INTO".len()..at].trim();
                let (of, columns) = head.split_once('(').map_or((head, None), |(of, rest)| (of, rest.rsplit_once(')')));
                let of = bare(of.trim());
                if table.as_ref().is_some_and(|table| *table != of) {
                    return None;
                }
                table = Some(of);
                if let Some((columns, _)) = columns {
                    let own: Vec<String> = cells(columns).into_iter().map(|name| bare(&name)).collect();
                    if begun && own != names {
                        return None;
                    }
                    names = own;
                }
                rest = line.get(at + "VALUES".len()..).unwrap_or_default();
            }
            rows = tuples(rest)?;
            inside = !line.ends_with(';');
        }
        for row in rows {
            if row.len() != names.len() {
                return None;
            }
            if !begun {
                found.push_str(&names.join("\t"));
            }
            // A lone carriage return ends a row, and no line.
            if !begun || !found.ends_with('\n') {
                found.push('\r');
            }
            found.push_str(&row.join("\t"));
            begun = true;
        }
        found.push('\n');
    }
    begun.then_some(found)
}

/// Words that begin what is no column of a table.
const CONSTRAINTS: [&str; 6] = ["PRIMARY", "FOREIGN", "UNIQUE", "CONSTRAINT", "CHECK", "KEY"];

/// A name without the marks around it.
fn bare(name: &str) -> String {
    name.trim().trim_matches(['`', '"', '[', ']', '\'']).to_owned()
}

/// The values between brackets, `(1, 'a'), (2, NULL)`; `None` where brackets are not closed.
fn tuples(text: &str) -> Option<Vec<Vec<String>>> {
    let (mut found, mut quoted, mut from) = (Vec::new(), false, None);
    for (at, c) in text.char_indices() {
        match (c, from) {
            ('\'', _) => quoted = !quoted,
            ('(', None) if !quoted => from = Some(at + 1),
            (')', Some(start)) if !quoted => {
                found.push(cells(&text[start..at]).into_iter().map(|value| plain(&value)).collect());
                from = None;
            }
            _ => {}
        }
    }
    (from.is_none() && !quoted).then_some(found)
}

/// What commas part, outside of quotes and brackets.
fn cells(text: &str) -> Vec<String> {
    let (mut found, mut quoted, mut deep) = (vec![String::new()], false, 0_usize);
    for c in text.chars() {
        match c {
            '\'' => quoted = !quoted,
            '(' if !quoted => deep += 1,
            ')' if !quoted => deep = deep.saturating_sub(1),
            _ => {}
        }
        match found.last_mut() {
            Some(last) if c != ',' || quoted || deep > 0 => last.push(c),
            _ => found.push(String::new()),
        }
    }
    found.iter().map(|cell| cell.trim().to_owned()).collect()
}

/// A value of a database as a cell: a text without its quotes, and nothing where there is none.
fn plain(value: &str) -> String {
    let text = value.strip_prefix('\'').and_then(|value| value.strip_suffix('\''));
    let text = text.map(|text| text.replace("''", "'").replace(['\t', '"'], " "));
    text.unwrap_or_else(|| if value.eq_ignore_ascii_case("null") { String::new() } else { value.to_owned() })
}

/// The lists of a script, `h = [1.0, 0.64 ...` with the rest in the next line, a row each behind
/// their names; a unit that a remark behind the list states is that of its numbers. Of other lines
/// the remarks are left: what is done with the lists says nothing of them. `None` where no list
/// goes on in another line, none bears such a remark, and nothing is done with any.
pub(super) fn scripted(text: &str) -> Option<String> {
    let mut found: Vec<String> = Vec::new();
    let (mut special, mut lists) = (false, 0);
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let (mut code, mut remark) = remarked(line);
        let (name, begun) = code.split_once('=').unwrap_or_default();
        let (name, begun) = (name.trim().to_owned(), begun.to_owned());
        let named = !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_');
        let open = |code: &str| code.matches(['[', '(', '{']).count() > code.matches([']', ')', '}']).count();
        if !named || !begun.contains(['[', '(', '{']) {
            special |= lists > 0 && code.contains('(') && code.ends_with([')', ';']);
            found.push(if remark.is_empty() { String::new() } else { format!("#{remark}") });
            continue;
        }
        let mut more = 0;
        while open(&code) && lines.peek().is_some() {
            let (next, said) = remarked(lines.next().unwrap_or_default());
            code = format!("{} {}", code.trim_end().trim_end_matches("..."), next);
            remark = if said.is_empty() { remark } else { said };
            more += 1;
        }
        let code = code.trim().trim_end_matches(';').to_owned();
        let values = listed_values(code.split_once('=').map_or("", |(_, value)| value.trim()));
        let number = |value: &String| matches!(cell::read(value, false), Cell::Number(_));
        if values.len() < LIST || !values.iter().all(number) {
            found.push(if remark.is_empty() { String::new() } else { format!("#{remark}") });
            found.extend(std::iter::repeat_n(String::new(), more));
            continue;
        }
        lists += 1;
        let called = Some(&*remark).filter(|_| Heading::parse(&name).unit.is_none()).and_then(|r| measures(&name, r));
        let unit = called.is_some();
        special |= more > 0 || unit;
        found.push(format!("{}\t{}", called.unwrap_or(name), values.join("\t")));
        found.extend(std::iter::repeat_n(String::new(), more));
        // Any other remark is kept, in a line that the list leaves.
        if !unit && !remark.is_empty() {
            let place = found.last_mut().filter(|_| more > 0)?;
            *place = format!("#{remark}");
        }
    }
    (special && lists > 0).then(|| found.join("\n") + "\n")
}

/// What a list of this name holds by the remark behind it: its unit, and what is measured where
/// the remark says that too, `m, distance from the sensor`.
fn measures(name: &str, remark: &str) -> Option<String> {
    let says = |said: &Heading| said.understood() && said.value().is_some_and(|value| value.what != What::Unsaid);
    let said = Heading::parse(remark);
    if Unit::parse(remark).is_none() && said.unit.is_some() && says(&said) {
        return Some(remark.to_owned());
    }
    let (unit, words) = remark.split_once(", ").unwrap_or((remark, ""));
    Unit::parse(unit)?;
    Some(format!("{} ({unit})", if says(&Heading::parse(words)) { words } else { name }))
}

/// A line of a script without the remark at its end, and that.
fn remarked(line: &str) -> (String, String) {
    let at = ["%", "#", "//"].iter().filter_map(|sign| line.find(sign)).min();
    let (code, remark) = line.split_at(at.unwrap_or(line.len()));
    let remark = remark.trim_start_matches(['%', '#', '/']).trim();
    // What is a remark only so that it is not run.
    let idle = remark.contains('(') && remark.contains(");") || remark.ends_with(';');
    (code.trim_end().to_owned(), if idle { String::new() } else { remark.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_of_data_holds_a_word_for_each_name() {
        let text = "#>>> df\n   ball  drop_m floor\n0  golf     1.0 stone\n1  golf     1.5 stone\n2  golf     2.0 stone\n\n[3 rows]\n";
        let expected = "#>>> df\n\tball\tdrop_m\tfloor\n0\tgolf\t1.0\tstone\n1\tgolf\t1.5\tstone\n2\tgolf\t2.0\tstone\n\n#[3 rows]\n";
        assert_eq!(indexed(text).as_deref(), Some(expected));
        for text in [
            "ball drop_m floor\n0 golf 1.0 stone\n1 old golf 1.5 stone\n2 golf 2.0 stone\n",
            "a b\n5 1.0 2.0\n7 1.5 2.0\n9 2.0 2.0\n",
            "the ball fell\n0 1 2\n",
        ] {
            assert_eq!(indexed(text), None, "{text}");
        }
    }

    #[test]
    fn rows_are_inserted_below_their_names() {
        let text = "-- golf, (old)\nCREATE TABLE d (id INT, h_mm DECIMAL(5,1), note TEXT,\n  PRIMARY KEY (id));\nINSERT INTO d VALUES (1, 640.5, 'it''s, ok');\nINSERT INTO d VALUES (2, NULL, ''), (3, 630, NULL);\nCOMMIT;\n";
        let expected = "# golf, (old)\n\n\nid\th_mm\tnote\r1\t640.5\tit's, ok\n2\t\t\r3\t630\t\n\n";
        assert_eq!(dumped(text).as_deref(), Some(expected));
        let text = "insert into d (drop, rebound) values\n(100, 64),\n(80, 51);\n";
        assert_eq!(dumped(text).as_deref(), Some("\ndrop\trebound\r100\t64\n80\t51\n"));
        for text in [
            "INSERT INTO a VALUES (1, 2);\n",
            "INSERT INTO a (x, y) VALUES (1, 2);\nINSERT INTO b (x, y) VALUES (1, 2);\n",
            "INSERT INTO a (x, y) VALUES (1, 2);\nINSERT INTO a (y, x) VALUES (1, 2);\n",
            "INSERT INTO a (x, y) VALUES (1, 2;\n",
            "values,insert\n1,2\n",
        ] {
            assert_eq!(dumped(text), None, "{text}");
        }
    }

    #[test]
    fn a_list_goes_on_to_its_bracket() {
        let text = "% golf\ng = 9.81;\nh = [1.0 0.64 ...\n  0.41];  % m\nplot(h)\n";
        assert_eq!(scripted(text).as_deref(), Some("#golf\n\nh (m)\t1.0\t0.64\t0.41\n\n\n"));
        let text = "h = [1.0 0.64 ...\n  0.41];  % in metres, not measured\n";
        assert_eq!(scripted(text).as_deref(), Some("h\t1.0\t0.64\t0.41\n#in metres, not measured\n"));
        let text = "%% drop\n% p = fit(n, h);  TODO\nh = [1.0 0.64 ...\n  0.41];  % m\n";
        assert_eq!(scripted(text).as_deref(), Some("#drop\n\nh (m)\t1.0\t0.64\t0.41\n\n"));
        let text = "h_cm = np.array([100, 64,\n    41])\n";
        assert_eq!(scripted(text).as_deref(), Some("h_cm\t100\t64\t41\n\n"));
        for text in ["h = [1.0 0.64 0.41];\n", "h = [1.0 0.64\n", "h = f(1,\n 2)\n", "height_cm\n100\n64\n"] {
            assert_eq!(scripted(text), None, "{text}");
        }
    }
}
