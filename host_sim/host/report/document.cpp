#include "host_sim/host/report/document.hpp"

#include <utility>

#include "host_sim/host/report/text_of.hpp"

namespace volcomp::host {
namespace {

using nlohmann::json;

void add_chapter(json& sections, const char* chapter, json added) {
  for (json& section : added) {
    section["chapter"] = chapter;
    sections.push_back(std::move(section));
  }
}

}  // namespace

json report_document(ReportParts parts) {
  json sections = json::array();
  if (!parts.before_after.is_null())
    add_chapter(sections, "Result", json::array({in_summary(std::move(parts.before_after))}));
  add_chapter(sections, "Plots", std::move(parts.plots));
  add_chapter(sections, "Details", std::move(parts.details));
  if (parts.ticks) add_chapter(sections, "Tick statistics", parts.ticks());
  json document{{"title", parts.title},
                {"subtitle", parts.subtitle},
                {"sections", std::move(sections)},
                {"provenance", std::move(parts.provenance["rows"])},
                {"inputs", std::move(parts.provenance["inputs"])}};
  if (parts.verdict)
    document["verdict"] = {{"ok", parts.verdict->ok}, {"text", parts.verdict->text}};
  return document;
}

json in_summary(json section) {
  section["summary"] = true;
  return section;
}

std::string terminal_text(const json& document) {
  json shown = document;
  shown["sections"] = json::array();
  for (const json& section : document["sections"]) {
    if (section.value("summary", false)) shown["sections"].push_back(section);
  }
  return text_of(shown);
}

}  // namespace volcomp::host
