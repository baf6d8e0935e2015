// Reports of plans and estimates: what their pictures hold is what was found.

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/host/measure/identify/found_report.hpp"
#include "host_sim/host/measure/identify/identified_document.hpp"
#include "host_sim/host/measure/identify/identified_report.hpp"
#include "host_sim/host/measure/identify/plan_document.hpp"
#include "host_sim/host/measure/identify/plan_report.hpp"
#include "tests/host_sim/host/measure/identify/simulated_plan.hpp"

namespace volcomp::test {
namespace {

using nlohmann::json;

void no_progress(double /*done*/, const std::string& /*what*/) {}

Identified identified(const MeasurementPlan& plan, bool leave_out = false) {
  IdentifySettings settings;
  settings.leave_out = leave_out;
  return identify(plan, settings, no_progress);
}

const json& section_of(const json& document, const std::string& id) {
  for (const json& section : document["sections"])
    if (section.value("id", "") == id) return section;
  throw std::out_of_range("no section " + id);
}

json titles_of(const json& sections) {
  json titles = json::array();
  for (const json& section : sections)
    titles.push_back(section["title"]);
  return titles;
}

// Curves of a document by name of function: "EXY" is channel EX in a chart of Y.
const json& curve_of(const json& document, const MeasurementPlan& plan, const Quantity& quantity) {
  const std::string letter(1, plan.machine.axes[quantity.axis].letter);
  const std::string id = "function-" + letter + (quantity.angular() ? "-angles" : "-lengths");
  for (const json& chart : section_of(document, "functions")["charts"]) {
    if (chart["id"] != id) continue;
    for (const json& series : chart["series"])
      if (series["name"] == kChannelNames.at(quantity.channel)) return series;
  }
  throw std::out_of_range("no curve " + quantity.name);
}

void expect_curves(const json& document, const MeasurementPlan& plan,
                   const std::vector<FoundFunction>& functions) {
  std::size_t curves = 0;
  for (const json& chart : section_of(document, "functions")["charts"])
    curves += chart["series"].size();
  EXPECT_EQ(curves, functions.size());
  for (const FoundFunction& f : functions) {
    const json& curve = curve_of(document, plan, f.quantity);
    ASSERT_EQ(curve["x"].size(), f.at.size());
    const double scale = f.quantity.angular() ? 1e6 : 1e3;
    for (std::size_t k = 0; k < f.at.size(); ++k) {
      const double value = scale * f.value[k].value;
      const double u = scale * f.value[k].u;
      EXPECT_NEAR(curve["y"][k].get<double>(), value, 1e-9);
      EXPECT_NEAR(curve["band"]["lo"][k].get<double>(), value - 2.0 * u, 1e-9);
      EXPECT_NEAR(curve["band"]["hi"][k].get<double>(), value + 2.0 * u, 1e-9);
    }
  }
}

TEST(IdentifiedDocument, CurvesAreTheFunctionsWithBandsOfTwoStandardUncertainties) {
  VectorXd truth;
  const MeasurementPlan plan = touched_plan(1, truth);
  const Identified found = identified(plan);
  const json document = identified_document(plan, found, {"volcomp identify", {}}, {});
  expect_curves(document, plan, found.functions);
  EXPECT_TRUE(document["verdict"]["ok"].get<bool>());
  // Nothing that JSON has no number for.
  EXPECT_EQ(json::parse(document.dump()), document);
}

TEST(IdentifiedDocument, EveryReadingHasAResidualAndTheirSquaresAreChiSquareOfTheSetUp) {
  VectorXd truth;
  const MeasurementPlan plan = touched_plan(2, truth);
  const Identified found = identified(plan);
  const json document = identified_document(plan, found, {"", {}}, {});
  const json& residuals = section_of(document, "residuals");
  ASSERT_EQ(residuals["series"].size(), plan.problem.setups.size());
  for (std::size_t k = 0; k < plan.problem.setups.size(); ++k) {
    const json& series = residuals["series"][k];
    EXPECT_EQ(series["y"].size(), plan.problem.setups[k].y.size());
    double squares = 0.0;
    for (const json& r : series["y"])
      squares += r.get<double>() * r.get<double>();
    EXPECT_NEAR(squares, found.consistency.setups[k].chi2, 1e-9);
  }
}

TEST(IdentifiedDocument, HasTheSectionsOfTheTextAmongItsDetails) {
  VectorXd truth;
  const MeasurementPlan plan = touched_plan(3, truth);
  const Identified found = identified(plan, true);
  const json document = identified_document(plan, found, {"", {}}, {});
  const json titles = titles_of(document["sections"]);
  for (const json& title : titles_of(identified_sections(plan, found)))
    EXPECT_THAT(titles, testing::Contains(title));
  EXPECT_EQ(section_of(document, "leave-out")["categories"].size(), plan.problem.setups.size());
}

TEST(PlanDocument, PredictsBandsAboutZero) {
  VectorXd truth;
  const MeasurementPlan plan = touched_plan(1, truth);
  const PlanPrediction predicted = predict_plan(plan, no_progress);
  const json document = plan_document(plan, predicted, {"", {}}, {});
  expect_curves(document, plan, predicted.functions);
  for (const FoundFunction& f : predicted.functions)
    for (const json& y : curve_of(document, plan, f.quantity)["y"])
      EXPECT_DOUBLE_EQ(y.get<double>(), 0.0);
  const json& order = section_of(document, "order");
  ASSERT_EQ(order["categories"].size(), plan.problem.setups.size());
  EXPECT_EQ(order["categories"][0], plan.problem.setups[predicted.order[0]].name);
  EXPECT_NEAR(order["series"][0]["values"].back().get<double>(), 1e3 * predicted.rms_u.back(),
              1e-9);
}

TEST(PlanDocument, WithoutEnoughSetUpsSaysSoAndHasNoBands) {
  VectorXd truth;
  MeasurementPlan plan = touched_plan(1, truth);
  plan.problem.styli.resize(1);
  plan.problem.setups.resize(1);
  host::identify::SetUp& s = plan.problem.setups[0];
  s.stylus.assign(s.q.size(), 0);
  const PlanPrediction predicted = predict_plan(plan, no_progress);
  const json document = plan_document(plan, predicted, {"", {}}, {});
  EXPECT_FALSE(document["verdict"]["ok"].get<bool>());
  EXPECT_THAT(titles_of(document["sections"]), testing::Not(testing::Contains("Error functions")));
  EXPECT_NO_THROW(section_of(document, "plan"));
}

// Sections go through the middle of the travels: where two cross they agree, and they are as large
// as what is stated for all places.
TEST(PlanDocument, SectionsOfTheVolumeAgreeWhereTheyCross) {
  VectorXd truth;
  const MeasurementPlan plan = touched_plan(1, truth);
  const PlanPrediction predicted = predict_plan(plan, no_progress);
  ASSERT_EQ(predicted.sections.size(), 3U);
  double largest = 0.0;
  for (const VolumeSection& section : predicted.sections) {
    const std::size_t middle = section.row.size() / 2;
    EXPECT_NEAR(section.u[middle][middle], predicted.sections[0].u[middle][middle], 1e-12);
    for (const auto& row : section.u)
      largest = std::max(largest, *std::max_element(row.begin(), row.end()));
  }
  EXPECT_GT(largest, predicted.volume.rms);
  EXPECT_LT(predicted.sections[0].u[6][6], predicted.volume.rms);
}

TEST(PlanPicture, ShowsEverySphereOfEveryPlacementOnceWhereItLies) {
  VectorXd truth;
  const MeasurementPlan plan = touched_plan(1, truth);
  const PlanPrediction predicted = predict_plan(plan, no_progress);
  const json document = plan_document(plan, predicted, {"", {}}, {});
  const json& picture = section_of(document, "plan");
  const Artefact& plate = plan.problem.artefacts[0];
  for (std::size_t k = 0; k < plan.problem.setups.size(); ++k) {
    const host::identify::SetUp& s = plan.problem.setups[k];
    const json& series = picture["series"][k];
    EXPECT_EQ(series["name"], s.name);
    std::vector<std::size_t> touched = s.sphere;
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    ASSERT_EQ(series["points"].size(), touched.size());
    ASSERT_EQ(series["labels"].size(), touched.size());
    for (std::size_t i = 0; i < touched.size(); ++i) {
      const Vec3 wanted = s.pose->R * plate.spheres[touched[i]] + s.pose->t;
      for (Eigen::Index c = 0; c < 3; ++c)
        EXPECT_NEAR(series["points"][i][static_cast<std::size_t>(c)].get<double>(), wanted(c), 0.5);
    }
  }
}

// Correlated values: in the covariance of the estimate itself.
TEST(WeakestValues, AreTheLargestOfTheirKindAndCorrelationsArePossible) {
  VectorXd truth;
  const MeasurementPlan plan = touched_plan(1, truth);
  const PlanPrediction predicted = predict_plan(plan, no_progress);
  ASSERT_EQ(predicted.weakest.size(), kWeakest);
  for (std::size_t k = 0; k < kWeakest; ++k) {
    const WeakValue& w = predicted.weakest[k];
    EXPECT_LE(w.times, predicted.weakest[k > 0 ? k - 1 : 0].times);
    EXPECT_GT(std::abs(w.correlation), 0.0);
    EXPECT_LE(std::abs(w.correlation), 1.0 + 1e-9);
    EXPECT_THAT(w.with, testing::Not(testing::HasSubstr(w.quantity.name)));
    for (const FoundFunction& f : predicted.functions) {
      if (f.quantity.name != w.quantity.name) continue;
      EXPECT_NEAR(w.u, f.largest_u(), 1e-12);
    }
  }
}

TEST(WeakestValues, EveryUnknownOfAnInstrumentHasANameOfItsOwn) {
  VectorXd truth;
  MeasurementPlan plan = touched_plan(1, truth);
  plan.problem.artefacts[0].scale = 1e-6;
  plan.problem.setups[0].scale = 1e-6;
  const Unknowns unknowns(plan.problem, true);
  std::vector<std::string> names = unknown_names(unknowns);
  ASSERT_EQ(names.size(), static_cast<std::size_t>(unknowns.size()));
  names.erase(names.begin(), names.begin() + unknowns.of_machine());
  EXPECT_THAT(names, testing::Each(testing::Not(testing::IsEmpty())));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
}

TEST(SpheresByTip, OneLineASetUpAndTip) {
  EXPECT_THAT(
      spheres_by_tip({"flat: sphere 3 with tip S1", "flat: sphere 12 with tip S1",
                      "flat: sphere 3 with tip S2"}),
      testing::ElementsAre("flat with tip S1: spheres 3 12", "flat with tip S2: spheres 3"));
}

}  // namespace
}  // namespace volcomp::test
