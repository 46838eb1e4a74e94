//! What Régressi writes: pages of readings, the names and units of whose columns stand above them
//! one a line.

/// A line of its text.
enum Said {
    /// It says nothing of the readings.
    Nothing,
    Remark,
    /// The rows of a page follow, below these names.
    Names(Vec<String>),
    Row,
}

/// The pages of its text as tables with tabs, `None` where it is none: sections such as `£3 NOM
/// VAR`, each with so many lines below it. A line stays a line.
pub(in crate::read) fn tables(text: &str) -> Option<String> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    if !lines.first()?.to_uppercase().contains("REGRESSI") {
        return None;
    }
    let (mut names, mut units): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
    let mut said = vec![Said::Nothing];
    let mut at = 1;
    while at < lines.len() {
        let count = counted(lines[at]).unwrap_or(0);
        let end = (at + 1).saturating_add(count).min(lines.len());
        let below = &lines[at + 1..end];
        let section = lines[at].split_once(' ').map_or("", |(_, section)| section.trim());
        let mut head = Said::Nothing;
        let line = |_: &&str| match section {
            "VALEUR VAR" => Said::Row,
            "MEMO GRANDEURS" => Said::Remark,
            _ => Said::Nothing,
        };
        match section {
            "NOM VAR" => names = below.to_vec(),
            "UNITE VAR" => units = below.to_vec(),
            "VALEUR VAR" => {
                let named = names.iter().enumerate().map(|(n, name)| match units.get(n) {
                    Some(unit) if !unit.is_empty() => format!("{name} ({unit})"),
                    _ => (*name).to_owned(),
                });
                head = Said::Names(named.collect());
            }
            _ => {}
        }
        said.push(head);
        said.extend(below.iter().map(line));
        at = end;
    }
    let pages = said.iter().filter(|said| matches!(said, Said::Names(_))).count();
    let mut page = 0;
    let mut spelt = |(line, said): (&str, &Said)| match said {
        Said::Nothing => String::new(),
        Said::Remark => format!("#{}", line.trim_start_matches('\'')),
        Said::Row => line.split_whitespace().collect::<Vec<_>>().join("\t"),
        Said::Names(names) => {
            page += 1;
            // A lone carriage return ends a row, and no line.
            let label = if pages > 1 { format!("page {page}\r") } else { String::new() };
            format!("{label}{}", names.join("\t"))
        }
    };
    let found: Vec<String> = lines.into_iter().zip(&said).map(&mut spelt).collect();
    (pages > 0).then(|| found.join("\n") + "\n")
}

/// How many lines a section has: its first word is a sign, `£` or `&`, in whatever encoding it is
/// read, and that number.
fn counted(head: &str) -> Option<usize> {
    let mut sign = head.split(' ').next()?.chars();
    sign.next().filter(|c| !c.is_ascii_alphanumeric())?;
    sign.as_str().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::tables;

    #[test]
    fn sections_have_their_lines() {
        let head = "EVARISTE REGRESSI WINDOWS 1.0\n£2 NOM VAR\nt\nn\n£2 UNITE VAR\ns\n\n£1 MEMO GRANDEURS\n'Une balle, un sol\n";
        let page = "£1 PAGE COMMENT\n'x\n&2 VALEUR VAR\n0.0 1.5\n0.1 1.4\n";
        let expected = "\n\n\n\n\n\n\n\n#Une balle, un sol\n\n\nt (s)\tn\n0.0\t1.5\n0.1\t1.4\n";
        assert_eq!(tables(&format!("{head}{page}")).as_deref(), Some(expected));
        let two = tables(&format!("{head}{page}{page}")).unwrap();
        assert!(two.contains("\npage 1\rt (s)\tn\n") && two.contains("\npage 2\rt (s)\tn\n"), "{two}");
        for text in ["", "t\tn\n0\t1\n", "EVARISTE REGRESSI\n£2 NOM VAR\nt\n"] {
            assert_eq!(tables(text), None, "{text}");
        }
    }
}
