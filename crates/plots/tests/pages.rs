//! Pages with arbitrary content.

use dem_plots::{Axis, Column, Page, Plot, Row, Table};

const NASTY: &str = "a\u{1b}[31m\n\u{9b}\u{202e}\u{2066}\u{7f}<script>\"&é";
const SHOWN: &str = "a\\u{1b}[31m\\u{a}\\u{9b}\\u{202e}\\u{2066}\\u{7f}&lt;script&gt;&quot;&amp;é";

#[test]
fn pages_hold_neither_tags_nor_control_characters_of_others() {
    let mut page = Page::new(NASTY);
    page.heading(NASTY);
    page.paragraph(NASTY);
    page.small(NASTY);
    page.list(&[NASTY.to_owned()]);
    page.table(&Table {
        columns: vec![Column::text(NASTY), Column::number("b")],
        rows: vec![Row {
            cells: vec![NASTY.to_owned(), "7".to_owned()],
            is_bad: true,
            link: Some("runs/0001-1/report.html".to_owned()),
        }],
    });
    let plot = Plot {
        title: NASTY.to_owned(),
        x: Axis::of(NASTY),
        ..Plot::default()
    };
    page.figure(&plot.svg());
    let html = page.html();
    assert_eq!(html.matches(SHOWN).count(), 11, "{html}");
    let linked = format!("<td><a href=\"runs/0001-1/report.html\">{SHOWN}</a></td>");
    assert!(html.contains(&linked), "{html}");
    assert!(!html.contains("<script>") && html.contains("<td class=\"n\">7</td>"));
    assert!(!html.chars().any(|c| c.is_control() && c != '\n'));
    // No other address is requested.
    assert!(!html.contains("http"));
    assert!(html.starts_with("<!DOCTYPE html>") && html.ends_with("</html>\n"));
}

#[test]
fn a_table_without_names_has_no_head() {
    let mut page = Page::new("a");
    page.table(&Table {
        columns: vec![Column::text(""), Column::number("")],
        rows: vec![Row::default()],
    });
    page.list(&[]);
    let html = page.html();
    assert!(!html.contains("<th") && !html.contains("<ul>"), "{html}");
}
