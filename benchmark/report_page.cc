#include "benchmark/report_page.h"

#include <set>
#include <string_view>

#include "base/html.h"
#include "benchmark/run_labels.h"
#include "benchmark/table.h"

namespace terra::benchmark {
namespace {

constexpr std::string_view kStyle = R"(
:root{--paper:#fff;--ink:#1c2430;--soft:#5b6675;--line:#e3e7ee;--band:#f5f7fb;
--accent:#1f4fe0;--accent2:#c2410c;--muted:#8a8f98;--grid:#e3e7ee}
@media (prefers-color-scheme:dark){:root{--paper:#12161d;--ink:#e6eaf0;
--soft:#9aa5b4;--line:#2a313c;--band:#1a2029;--accent:#7c9dff;--accent2:#ff9a62;
--muted:#7d8694;--grid:#2a313c}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);
font:15px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif}
main,header,nav,footer{max-width:1480px;margin:0 auto;padding:0 24px}
header{padding-top:40px}
h1{font-size:30px;line-height:1.2;margin:0 0 8px}
h2{font-size:21px;margin:48px 0 6px;padding-top:12px;border-top:1px solid var(--line)}
h3{font-size:16px;margin:28px 0 8px}
p{max-width:78ch;color:var(--soft);margin:6px 0 14px}
nav ul{list-style:none;display:flex;flex-wrap:wrap;gap:6px 18px;padding:0;margin:14px 0}
nav a{color:var(--accent);text-decoration:none}
.facts{display:flex;flex-wrap:wrap;gap:12px;margin:18px 0}
.facts div{background:var(--band);border:1px solid var(--line);border-radius:8px;padding:10px 16px}
.facts b{display:block;font-size:20px}
.facts span{color:var(--soft);font-size:13px}
figure{margin:22px 0}
figcaption{font-weight:600;margin-bottom:8px}
figure.plot figcaption{font-weight:400;color:var(--soft);font-size:13px}
figure.plot svg{width:100%;max-width:820px;height:auto}
.scroll{overflow-x:auto;border:1px solid var(--line);border-radius:8px}
table{border-collapse:collapse;width:100%;font-size:13px;font-variant-numeric:tabular-nums}
th,td{padding:5px 7px;text-align:right;border-bottom:1px solid var(--line);vertical-align:top}
.words{text-align:left}
tr>*:first-child{min-width:170px;max-width:330px}
tbody th{font-weight:500}
thead th{background:var(--band);font-weight:600;vertical-align:bottom;overflow-wrap:normal}
tbody:last-child tr:last-child>*{border-bottom:0}
tr.heading th{text-align:left;background:var(--band);color:var(--soft);font-weight:600;font-size:12px;max-width:none}
tr.published>*{color:var(--soft);font-style:italic}
td.command{text-align:left;color:var(--soft);font-family:ui-monospace,monospace;font-size:12px}
.interval{display:block;color:var(--soft);font-size:11px;white-space:nowrap}
.note{font-size:12.5px;margin:6px 0 0}
#runs td,#runs th{font-size:12px}
#runs td:nth-child(2),#runs td:nth-child(8){overflow-wrap:anywhere;min-width:110px}
#runs td:last-child{font-family:ui-monospace,monospace;min-width:320px;overflow-wrap:anywhere}
.panels{display:grid;grid-template-columns:repeat(auto-fill,minmax(300px,1fr));gap:18px}
.panels figure{margin:0}
.panels img{width:100%;height:auto;border:1px solid var(--line);border-radius:6px;display:block}
.panels figcaption{font-weight:400;font-size:12.5px;color:var(--soft);margin-top:6px}
footer{margin-top:48px;padding-bottom:32px;color:var(--soft);font-size:13px}
@page{size:A3 landscape;margin:12mm}
@media print{nav{display:none}main,header,footer{max-width:none;padding:0}
.scroll{overflow:visible}tr,figure.plot,.panels figure{break-inside:avoid}
h2,h3,figcaption{break-after:avoid}.panels{display:block}
.panels figure{display:inline-block;width:31%;margin:0 1% 12px 0}}
)";

std::string Fact(const std::string& value, const std::string& label) {
  return "<div><b>" + EscapeHtml(value) + "</b><span>" + EscapeHtml(label) +
         "</span></div>\n";
}

}  // namespace

void ReportPage::Intro(const std::vector<LoadedRun>& runs) {
  std::set<std::string> datasets;
  std::set<std::string> builds;
  std::int64_t rows = 0;
  bool models = false;
  for (const LoadedRun& run : runs) {
    datasets.insert(DatasetTitle(run.description));
    builds.insert(run.description.build_id);
    rows += run.num_rows;
    models = models || run.description.asks_model;
  }
  std::string names;
  for (const std::string& name : datasets) {
    names += (names.empty() ? "" : ", ") + name;
  }
  intro_ =
      "<header>\n<h1>TerraAdvisor benchmark</h1>\n<p>Routes of a coarse "
      "lattice planner, and what advisors make of them, on fine terrain maps. "
      "The maps are generated after the description in the LLM-Advisor paper "
      "and are not its maps; its printed rows stand in blocks of their own and "
      "are not comparable number by number.</p>\n<div class=\"facts\">\n";
  intro_ += Fact(std::to_string(runs.size()), "runs");
  intro_ += Fact(std::to_string(rows), "scored cases");
  intro_ += Fact(models ? "yes" : "none", "rows of a language model");
  intro_ += Fact(names, "datasets");
  for (const std::string& build : builds) intro_ += Fact(build, "build");
  intro_ += "</div>\n</header>\n";
}

void ReportPage::Section(const std::string& title, const std::string& text) {
  const std::string id = "s" + std::to_string(++sections_);
  contents_ +=
      "<li><a href=\"#" + id + "\">" + EscapeHtml(title) + "</a></li>\n";
  body_ += "<h2 id=\"" + id + "\">" + EscapeHtml(title) + "</h2>\n";
  if (!text.empty()) body_ += "<p>" + EscapeHtml(text) + "</p>\n";
}

void ReportPage::Figure(const std::string& svg, const std::string& caption) {
  body_ += "<figure class=\"plot\">\n" + svg + "<figcaption>" +
           EscapeHtml(caption) + "</figcaption>\n</figure>\n";
}

void ReportPage::BeginPanels(const std::string& title) {
  body_ += "<h3>" + EscapeHtml(title) + "</h3>\n<div class=\"panels\">\n";
}

void ReportPage::AddPanel(const std::string& caption,
                          const std::string& png_base64) {
  body_ += "<figure><img alt=\"" + EscapeHtml(caption) +
           "\" src=\"data:image/png;base64," + png_base64 + "\"><figcaption>" +
           EscapeHtml(caption) + "</figcaption></figure>\n";
}

void ReportPage::EndPanels() {
  body_ += "</div>\n";
}

std::string ReportPage::Finish() const {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta "
         "charset=\"utf-8\">\n<meta name=\"viewport\" "
         "content=\"width=device-width, initial-scale=1\">\n"
         "<title>TerraAdvisor benchmark</title>\n<style>" +
         std::string(kStyle) + "</style>\n</head>\n<body>\n" + intro_ +
         "<nav><ul>\n" + contents_ + "</ul></nav>\n<main>\n" + body_ +
         "</main>\n<footer>Definitions of every column: docs/benchmark.md. "
         "The paper: LLM-Advisor.</footer>\n</body>\n</html>\n";
}

}  // namespace terra::benchmark
