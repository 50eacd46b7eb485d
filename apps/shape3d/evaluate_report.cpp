#include "evaluate_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "common/text.hpp"

namespace shape3d::apps {
namespace {

using learning::RetrievalMeans;

std::string percent(double share) {
  if (std::isnan(share)) return "–";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", 100.0 * share);
  return text;
}

std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

Json number_or_null(double value) { return std::isnan(value) ? Json(nullptr) : Json(value); }

Json to_json(const RetrievalMeans& means) {
  const learning::RetrievalMeasures& m = means.measures;
  Json json = {{"queries", means.queries},
               {"nearest_neighbour", m.nearest_neighbour},
               {"first_tier", m.first_tier},
               {"second_tier", m.second_tier},
               {"e_measure", m.e_measure},
               {"dcg", m.dcg},
               {"mean_average_precision", m.average_precision}};
  json["precision"] = Json::array();
  for (const double value : means.precision) json["precision"].push_back(number_or_null(value));
  return json;
}

Json to_json(const MethodResult& one, const Evaluation& evaluation) {
  Json json = {{"name", one.method->name},
               {"explanation", one.method->explanation},
               {"baseline", one.method->baseline}};
  json["micro"] = to_json(one.retrieval.micro);
  json["macro"] = to_json(one.retrieval.macro);
  json["classes"] = Json::array();
  for (std::size_t c = 0; c < one.retrieval.classes.size(); ++c) {
    if (one.retrieval.classes[c].queries == 0) continue;
    Json of_class = {{"name", evaluation.set->test.classes[c]}};
    of_class.update(to_json(one.retrieval.classes[c]));
    json["classes"].push_back(std::move(of_class));
  }
  return json;
}

Json to_json(const ClassifierResult& one, const Evaluation& evaluation) {
  const learning::Confusion& confusion = one.confusion;
  Json json = {{"name", one.result.name},
               {"baseline", one.result.baseline},
               {"models", confusion.total()},
               {"untrained", one.untrained},
               {"correct_rate", confusion.correct_rate()},
               {"balanced_rate", confusion.balanced_rate()},
               {"majority_rate", confusion.majority_rate()},
               {"C", one.result.C},
               {"gamma", one.result.gamma}};
  json["classes"] = evaluation.class_names;
  json["confusion"] = Json::array();
  for (Eigen::Index row = 0; row < confusion.counts.rows(); ++row) {
    Json counts = Json::array();
    for (Eigen::Index c = 0; c < confusion.counts.cols(); ++c) {
      counts.push_back(confusion.counts(row, c));
    }
    json["confusion"].push_back(std::move(counts));
  }
  return json;
}

std::size_t classes_with_models(const DescribedPart& part) {
  return std::set<int>(part.labels.begin(), part.labels.end()).size();
}

Json to_json(const DescribedPart& part) {
  Json json = {{"source", part.source},
               {"models", part.size()},
               {"classes", classes_with_models(part)},
               {"left_out", part.left_out},
               {"notes", part.notes}};
  return json;
}

// A table of texts: the first column to the left, the others to the right.
class Table {
 public:
  explicit Table(const std::vector<std::string>& head) : columns_(head.size()) {
    add(head);
    text_ += "|:--|";
    for (std::size_t c = 1; c < columns_; ++c) text_ += "--:|";
    text_ += '\n';
  }
  void add(std::vector<std::string> cells) {
    cells.resize(columns_);
    text_ += '|';
    for (std::string& cell : cells) {
      std::string safe;  // a bar would end the cell
      for (const char c : printable(cell))
        safe += c == '|' ? std::string("\\|") : std::string(1, c);
      text_ += ' ' + safe + " |";
    }
    text_ += '\n';
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static std::string printable(const std::string& text) {
    std::string result = text;
    for (char& c : result) {
      if (c >= 0 && c < ' ') c = '?';
    }
    return result;
  }

  std::size_t columns_;
  std::string text_;
};

std::string group_title(const GroupResult& group, const Evaluation& evaluation) {
  std::string title = group.group.name;
  if (group.group.without >= 0) {
    title += ": its members are no queries, but stay in the library";
  } else if (evaluation.groups.size() > 1) {
    title += ", the class -1 (miscellaneous) among them";
  }
  return title;
}

std::string retrieval_table(const GroupResult& group) {
  Table table({"method", "queries", "NN", "1st tier", "2nd tier", "E", "DCG", "MAP",
               "precision at recall 0.1"});
  for (const MethodResult& one : group.retrieval) {
    const RetrievalMeans& means = one.retrieval.micro;
    const learning::RetrievalMeasures& m = means.measures;
    table.add({one.method->name, std::to_string(means.queries), percent(m.nearest_neighbour),
               percent(m.first_tier), percent(m.second_tier), percent(m.e_measure), percent(m.dcg),
               percent(m.average_precision), percent(means.precision[1])});
  }
  table.add({"chance", "", percent(group.chance.nearest_neighbour),
             percent(group.chance.first_tier), percent(group.chance.second_tier), "", "", "", ""});
  return table.text();
}

std::string macro_table(const GroupResult& group) {
  Table table({"method", "NN", "1st tier", "2nd tier", "E", "DCG", "MAP"});
  for (const MethodResult& one : group.retrieval) {
    const learning::RetrievalMeasures& m = one.retrieval.macro.measures;
    table.add({one.method->name, percent(m.nearest_neighbour), percent(m.first_tier),
               percent(m.second_tier), percent(m.e_measure), percent(m.dcg),
               percent(m.average_precision)});
  }
  return table.text();
}

std::string curve_table(const GroupResult& group) {
  std::vector<std::string> head{"recall"};
  for (const MethodResult& one : group.retrieval) head.push_back(one.method->name);
  Table table(head);
  for (std::size_t k = 0; k < learning::kRecallSteps; ++k) {
    std::vector<std::string> row{fixed(static_cast<double>(k + 1) / learning::kRecallSteps, 2)};
    for (const MethodResult& one : group.retrieval) {
      row.push_back(percent(one.retrieval.micro.precision[k]));
    }
    table.add(row);
  }
  return table.text();
}

std::string class_table(const GroupResult& group, const Evaluation& evaluation) {
  const learning::RetrievalResult& last = group.retrieval.back().retrieval;
  Table table({"class", "queries", "NN", "1st tier", "2nd tier", "E", "DCG", "MAP"});
  for (std::size_t c = 0; c < last.classes.size(); ++c) {
    const RetrievalMeans& means = last.classes[c];
    if (means.queries == 0) continue;
    const learning::RetrievalMeasures& m = means.measures;
    table.add({evaluation.set->test.classes[c], std::to_string(means.queries),
               percent(m.nearest_neighbour), percent(m.first_tier), percent(m.second_tier),
               percent(m.e_measure), percent(m.dcg), percent(m.average_precision)});
  }
  return table.text();
}

std::string classification_table(const GroupResult& group) {
  Table table({"trained on", "models", "CCR", "mean over classes", "C", "gamma"});
  for (const ClassifierResult& one : group.classification) {
    table.add({one.result.name, std::to_string(one.confusion.total()),
               percent(one.confusion.correct_rate()), percent(one.confusion.balanced_rate()),
               to_text(one.result.C), rounded(one.result.gamma)});
  }
  if (!group.classification.empty()) {
    const learning::Confusion& first = group.classification.front().confusion;
    table.add({"always the largest class", std::to_string(first.total()),
               percent(first.majority_rate()), "", "", ""});
  }
  return table.text();
}

std::string confusion_table(const ClassifierResult& one, const Evaluation& evaluation) {
  const Eigen::MatrixXi& counts = one.confusion.counts;
  std::vector<Eigen::Index> shown;
  for (Eigen::Index c = 0; c < counts.rows(); ++c) {
    if (counts.row(c).sum() + counts.col(c).sum() > 0) shown.push_back(c);
  }
  std::vector<std::string> head{"class, as predicted:"};
  for (const Eigen::Index c : shown) {
    head.push_back(evaluation.class_names[static_cast<std::size_t>(c)]);
  }
  Table table(head);
  for (const Eigen::Index row : shown) {
    std::vector<std::string> cells{evaluation.class_names[static_cast<std::size_t>(row)]};
    for (const Eigen::Index c : shown) cells.push_back(std::to_string(counts(row, c)));
    table.add(cells);
  }
  return table.text();
}

// Pairs of vectors of equal length.
std::string comparison_text(const GroupResult& group) {
  Table table({"first", "second", "only the first is right", "only the second is right", "p"});
  bool has_rows = false;
  for (const ComparedClassifiers& pair : group.comparisons) {
    if (!pair.equal_length) continue;
    has_rows = true;
    table.add({pair.first, pair.second, std::to_string(pair.test.first_only),
               std::to_string(pair.test.second_only), rounded(pair.test.p)});
  }
  if (!has_rows) return {};
  return "\nVectors of equal length on the same models, McNemar's exact test (two-sided):\n\n" +
         table.text();
}

std::string list_of(const std::vector<std::string>& sentences) {
  constexpr std::size_t kMost = 50;
  std::string text;
  for (std::size_t i = 0; i < std::min(sentences.size(), kMost); ++i) {
    text += "- " + sentences[i] + "\n";
  }
  if (sentences.size() > kMost) {
    text += "- and " + std::to_string(sentences.size() - kMost) + " more, in report.json\n";
  }
  return text;
}

std::string part_text(const char* name, const DescribedPart& part) {
  std::string text = std::string(name) + ": `" + part.source + "`, " + std::to_string(part.size()) +
                     " models in " + std::to_string(classes_with_models(part)) + " classes";
  if (!part.left_out.empty()) {
    text += "; left out: " + std::to_string(part.left_out.size());
  }
  text += ".\n\n" + list_of(part.left_out) + list_of(part.notes);
  if (!part.left_out.empty() || !part.notes.empty()) text += "\n";
  return text;
}

}  // namespace

Json to_json(const Evaluation& evaluation) {
  const EvaluatedSet& set = *evaluation.set;
  Json json = report_head("evaluate");
  json["folder"] = evaluation.arguments->folder;
  json["protocol"] = evaluation.protocol;
  json["train"] = set.train ? to_json(*set.train) : Json(nullptr);
  json["test"] = to_json(set.test);
  json["descriptors"] = Json::array();
  for (const EvaluatedDescriptor& one : set.descriptors) {
    json["descriptors"].push_back({{"name", one.name},
                                   {"spec", one.descriptor.to_string()},
                                   {"length", one.descriptor.length()},
                                   {"distance", learning::to_string(one.distance)},
                                   {"weight", one.weight},
                                   {"baseline", one.baseline}});
  }
  json["recall"] = Json::array();
  for (int k = 1; k <= learning::kRecallSteps; ++k) {
    json["recall"].push_back(static_cast<double>(k) / learning::kRecallSteps);
  }
  json["groups"] = Json::array();
  for (const GroupResult& group : evaluation.groups) {
    Json one = {{"name", group.group.name}};
    one["chance"] = {{"nearest_neighbour", group.chance.nearest_neighbour},
                     {"first_tier", group.chance.first_tier},
                     {"second_tier", group.chance.second_tier}};
    one["retrieval"] = Json::array();
    for (const MethodResult& method : group.retrieval) {
      one["retrieval"].push_back(to_json(method, evaluation));
    }
    one["classification"] = Json::array();
    for (const ClassifierResult& classifier : group.classification) {
      one["classification"].push_back(to_json(classifier, evaluation));
    }
    one["paired_tests"] = Json::array();
    for (const ComparedClassifiers& pair : group.comparisons) {
      one["paired_tests"].push_back({{"first", pair.first},
                                     {"second", pair.second},
                                     {"first_only", pair.test.first_only},
                                     {"second_only", pair.test.second_only},
                                     {"p", pair.test.p}});
    }
    json["groups"].push_back(std::move(one));
  }
  json["seconds"] = {{"describing", set.describing}, {"evaluating", evaluation.seconds}};
  json["described"] = set.described;
  json["kept"] = set.kept;
  return json;
}

std::string to_markdown(const Evaluation& evaluation) {
  const EvaluatedSet& set = *evaluation.set;
  std::string text = "# Retrieval and classification\n\n" + evaluation.protocol + "\n\n";
  if (set.train) text += part_text("Train", *set.train);
  text += part_text("Test", set.test);
  text +=
      "NN: the nearest is of the class. Tiers: share of the class among the |C| − 1 and 2(|C| − 1) "
      "nearest. E: of the first 32. DCG: discounted cumulative gain over that of a perfect "
      "ranking. "
      "MAP: mean average precision. All in percent; ties in the order of the class file. Classes "
      "of "
      "one model have no query. Chance: the mean over all orders.\n\n";
  for (const GroupResult& group : evaluation.groups) {
    const std::string title = group_title(group, evaluation);
    text += "## Retrieval, " + title + "\n\nMeans over the queries:\n\n" + retrieval_table(group) +
            "\nMeans over the classes:\n\n" + macro_table(group) +
            "\nPrecision at recalls, means over the queries whose class is large enough to have "
            "that recall:\n\n" +
            curve_table(group) + "\nClasses, by " + group.retrieval.back().method->name + ":\n\n" +
            class_table(group, evaluation) + "\n";
    if (group.classification.empty()) continue;
    text += "## Classification, " + title + "\n\n" + classification_table(group);
    const int untrained = group.classification.front().untrained;
    if (untrained > 0) {
      text += "\n" + std::to_string(untrained) +
              " models are of classes that were not trained, and are not counted.\n";
    }
    text += comparison_text(group);
    const ClassifierResult& last = group.classification.back();
    if (evaluation.class_names.size() <= 20) {
      text += "\nConfusions, trained on " + last.result.name + ":\n\n" +
              confusion_table(last, evaluation);
    }
    text += "\n";
  }
  text += "## Methods\n\n";
  for (const MethodResult& one : evaluation.groups.front().retrieval) {
    text += "- " + one.method->name + ": " + one.method->explanation + "\n";
  }
  text += "\nDescriptors in full:\n\n";
  for (const EvaluatedDescriptor& one : set.descriptors) {
    text += "- " + one.name + ": `" + one.descriptor.to_string() + "`, " +
            std::to_string(one.descriptor.length()) + " numbers\n";
  }
  text += "\n" + std::to_string(set.described) + " models were described in " +
          fixed(set.describing, 1) + " s, " + std::to_string(set.kept) +
          " were known from an earlier run; the rest took " + fixed(evaluation.seconds, 1) +
          " s.\n";
  return text;
}

std::string to_lines(const Evaluation& evaluation) {
  std::string text;
  for (const GroupResult& group : evaluation.groups) {
    text += group_title(group, evaluation) + "\n";
    for (const MethodResult& one : group.retrieval) {
      const learning::RetrievalMeasures& m = one.retrieval.micro.measures;
      char numbers[160];
      std::snprintf(numbers, sizeof numbers,
                    "NN %5.1f  1st tier %5.1f  2nd tier %5.1f  E %5.1f  DCG %5.1f",
                    100 * m.nearest_neighbour, 100 * m.first_tier, 100 * m.second_tier,
                    100 * m.e_measure, 100 * m.dcg);
      text += "  " + std::string(numbers) + "  " + one.method->name + "\n";
    }
    for (const ClassifierResult& one : group.classification) {
      text += "  CCR " + percent(one.confusion.correct_rate()) + "  " + one.result.name + "\n";
    }
  }
  return text;
}

}  // namespace shape3d::apps
