//! The skeleton of a page.

use super::{Table, escape};

const STYLE: &str = "\
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2, h3 { line-height: 1.2; margin: 2rem 0 .6rem; }
table { border-collapse: collapse; font-size: .85rem; margin: .6rem 0; }
th, td { padding: .15rem .6rem; border-bottom: 1px solid #ddd; text-align: left; vertical-align: top; }
.n { text-align: right; font-variant-numeric: tabular-nums; }
.bad td { background: #fde0dc; }
figure { margin: 1rem 0; }
figcaption { color: #555; font-size: .9rem; max-width: 44rem; }
.row { display: flex; flex-wrap: wrap; gap: 1rem; align-items: flex-start; }
.row figure { margin: 0; }
img, svg { max-width: 100%; height: auto; }
pre { background: #f4f4f4; padding: .5rem .8rem; overflow-x: auto; }
summary { cursor: pointer; margin: .6rem 0; }";

/// A page under construction. All text is escaped; only figures are taken as HTML.
#[derive(Clone, Debug)]
pub struct Document {
    title: String,
    body: String,
}

impl Document {
    /// A page with its title as the first heading.
    pub fn new(title: &str) -> Self {
        Self { title: title.into(), body: format!("<h1>{}</h1>\n", escape(title)) }
    }

    /// A heading of level 2 or 3.
    pub fn heading(&mut self, level: u8, text: &str) {
        let level = level.clamp(2, 3);
        self.body.push_str(&format!("<h{level}>{}</h{level}>\n", escape(text)));
    }

    /// A paragraph.
    pub fn paragraph(&mut self, text: &str) {
        self.body.push_str(&format!("<p>{}</p>\n", escape(text)));
    }

    /// A command to type.
    pub fn command(&mut self, text: &str) {
        self.body.push_str(&format!("<pre>{}</pre>\n", escape(text)));
    }

    /// A table.
    pub fn table(&mut self, table: &Table) {
        self.body.push_str(&table.to_html());
    }

    /// A long table behind a line that opens it.
    pub fn folded_table(&mut self, summary: &str, table: &Table) {
        let html = table.to_html();
        self.body.push_str(&format!("<details><summary>{}</summary>\n{html}</details>\n", escape(summary)));
    }

    /// SVG or an image element with a caption.
    pub fn figure(&mut self, html: &str, caption: &str) {
        self.body.push_str(&figure(html, caption));
    }

    /// Figures side by side: HTML and caption of each.
    pub fn figures(&mut self, figures: &[(String, String)]) {
        let all: String = figures.iter().map(|(html, caption)| figure(html, caption)).collect();
        self.body.push_str(&format!("<div class=\"row\">\n{all}</div>\n"));
    }

    /// The whole file.
    pub fn finish(self) -> String {
        let (title, body) = (escape(&self.title), self.body);
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
             <style>\n{STYLE}\n</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
        )
    }
}

fn figure(html: &str, caption: &str) -> String {
    format!("<figure>{html}<figcaption>{}</figcaption></figure>\n", escape(caption))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_nothing_is_loaded() {
        let mut page = Document::new("a < b");
        page.heading(2, "c & d");
        page.paragraph("<script>");
        page.figures(&[("<svg></svg>".into(), "one".into()), ("<svg></svg>".into(), "two".into())]);
        page.folded_table("all rows", &Table::new(["x"]).row(["1"]));
        let html = page.finish();
        assert!(html.contains("<title>a &lt; b</title>") && html.contains("&lt;script&gt;"));
        assert!(!html.contains("<script") && !html.contains("http"));
        assert_eq!(html.matches("<figure>").count(), 2);
    }
}
