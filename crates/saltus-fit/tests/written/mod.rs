//! Files as programs write them, made for tests.

use std::io::{Cursor, Write};

use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// A zip archive of files.
pub(crate) fn zip(files: &[(&str, &str)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in files {
        zip.start_file(*name, SimpleFileOptions::default()).expect("an entry");
        zip.write_all(content.as_bytes()).expect("its content");
    }
    zip.finish().expect("an archive").into_inner()
}

/// A workbook: sheets of rows of cells, numbers as numbers, the rest as text.
pub(crate) fn xlsx(sheets: &[(&str, Vec<Vec<String>>)]) -> Vec<u8> {
    let sheets: Vec<(&str, String)> = sheets.iter().map(|(name, rows)| (*name, data(rows))).collect();
    workbook(&sheets)
}

fn data(rows: &[Vec<String>]) -> String {
    let mut cells = String::new();
    for (row, values) in rows.iter().enumerate() {
        cells += &format!("<row r=\"{}\">", row + 1);
        for (column, value) in values.iter().enumerate().filter(|(_, value)| !value.is_empty()) {
            let at = format!("{}{}", char::from(b'A' + column as u8), row + 1);
            cells += &match value.parse::<f64>() {
                Ok(number) => format!("<c r=\"{at}\"><v>{number}</v></c>"),
                Err(_) => format!("<c r=\"{at}\" t=\"inlineStr\"><is><t>{value}</t></is></c>"),
            };
        }
        cells += "</row>";
    }
    cells
}

/// A workbook of sheets whose rows are given as XML.
pub(crate) fn workbook(sheets: &[(&str, String)]) -> Vec<u8> {
    workbook_with(sheets, Vec::new())
}

/// The same of one sheet, with remarks on its cells.
pub(crate) fn remarked(rows: &[Vec<String>], remarks: &[&str]) -> Vec<u8> {
    let texts = remarks
        .iter()
        .map(|text| format!("<comment ref=\"B1\"><text><r><t>Anna:</t></r><r><t> {text}</t></r></text></comment>"));
    let comments = format!("<comments><commentList>{}</commentList></comments>", texts.collect::<String>());
    let link = "<Relationships><Relationship Id=\"c\" Target=\"../comments/comment1.xml\"/></Relationships>";
    let files = [("xl/comments/comment1.xml", comments), ("xl/worksheets/_rels/sheet1.xml.rels", link.to_owned())];
    workbook_with(&[("Data", data(rows))], files.map(|(name, text)| (name.to_owned(), text)).to_vec())
}

fn workbook_with(sheets: &[(&str, String)], more: Vec<(String, String)>) -> Vec<u8> {
    const MAIN: &str = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    const LINKS: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    const PACKAGE: &str = "http://schemas.openxmlformats.org/package/2006/relationships";
    let (mut names, mut links, mut files) = (String::new(), String::new(), more);
    for (n, (name, cells)) in sheets.iter().enumerate() {
        let n = n + 1;
        names += &format!("<sheet name=\"{name}\" sheetId=\"{n}\" r:id=\"rId{n}\"/>");
        links +=
            &format!("<Relationship Id=\"rId{n}\" Type=\"{LINKS}/worksheet\" Target=\"worksheets/sheet{n}.xml\"/>");
        files.push((
            format!("xl/worksheets/sheet{n}.xml"),
            format!("<worksheet xmlns=\"{MAIN}\"><sheetData>{cells}</sheetData></worksheet>"),
        ));
    }
    files.push((
        "xl/workbook.xml".to_owned(),
        format!("<workbook xmlns=\"{MAIN}\" xmlns:r=\"{LINKS}\"><sheets>{names}</sheets></workbook>"),
    ));
    files.push((
        "xl/_rels/workbook.xml.rels".to_owned(),
        format!("<Relationships xmlns=\"{PACKAGE}\">{links}</Relationships>"),
    ));
    files.push((
        "_rels/.rels".to_owned(),
        format!(
            "<Relationships xmlns=\"{PACKAGE}\"><Relationship Id=\"rId1\" Type=\"{LINKS}/officeDocument\" \
             Target=\"xl/workbook.xml\"/></Relationships>"
        ),
    ));
    files.push((
        "[Content_Types].xml".to_owned(),
        "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"/>".to_owned(),
    ));
    let files: Vec<(&str, &str)> = files.iter().map(|(name, content)| (name.as_str(), content.as_str())).collect();
    zip(&files)
}

/// The cells of a table in text.
pub(crate) fn cells(text: &str) -> Vec<Vec<String>> {
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}
