#include "hal/rig/toml_section.hpp"

#include <cstdint>
#include <locale>
#include <sstream>
#include <utility>

namespace bodyscan {
namespace {

std::string number(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

}  // namespace

TomlSection::TomlSection(const toml::table& file, const std::string& name, std::vector<std::string>& problems)
    : name_(name), problems_(problems) {
  if (name.empty()) {
    table_ = &file;
    return;
  }
  const toml::node* node = file.get(name);
  if (node == nullptr) return;
  table_ = node->as_table();
  if (table_ == nullptr) problems_.push_back(name + ": must be a table, [" + name + "]");
}

const toml::node* TomlSection::find(const char* key) {
  known_.insert(key);
  return table_ == nullptr ? nullptr : table_->get(key);
}

void TomlSection::note(const std::string& key, const std::string& problem) {
  problems_.push_back((name_.empty() ? "" : name_ + ".") + key + ": " + problem);
}

std::optional<std::string> TomlSection::text(const char* key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (const auto* text = node->as_string()) return text->get();
  note(key, "must be a text in quotes");
  return std::nullopt;
}

void TomlSection::read(const char* key, std::string& value) {
  if (std::optional<std::string> given = text(key)) value = std::move(*given);
}

void TomlSection::read(const char* key, int& value, int least, int most) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto* whole = node->as_integer();
  if (whole == nullptr) {
    note(key, "must be a whole number");
  } else if (whole->get() < least || whole->get() > most) {
    note(key, std::to_string(whole->get()) + " is not between " + std::to_string(least) + " and " +
                  std::to_string(most));
  } else {
    value = static_cast<int>(whole->get());
  }
}

void TomlSection::read(const char* key, double& value, double least, double most) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto given = node->is_number() ? node->value<double>() : std::nullopt;
  if (!given) {
    note(key, "must be a number");
  } else if (!(*given >= least && *given <= most)) {
    note(key, number(*given) + " is not between " + number(least) + " and " + number(most));
  } else {
    value = *given;
  }
}

void TomlSection::read(const char* key, std::filesystem::path& value, const std::filesystem::path& folder) {
  const std::optional<std::string> name = text(key);
  if (!name) return;
  if (name->empty()) {
    note(key, "must not be empty");
  } else {
    value = folder / *name;
  }
}

void TomlSection::read(const char* key, Size& value, int most) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto* sides = node->as_array();
  std::array<std::int64_t, 2> read{};
  const bool valid = sides != nullptr && sides->size() == 2 && [&] {
    for (std::size_t i = 0; i < 2; ++i) {
      const auto* side = sides->get(i)->as_integer();
      if (side == nullptr || side->get() < 1 || side->get() > most) return false;
      read.at(i) = side->get();
    }
    return true;
  }();
  if (valid) {
    value = {static_cast<int>(read[0]), static_cast<int>(read[1])};
  } else {
    note(key, "must be [width, height], each 1 to " + std::to_string(most));
  }
}

void TomlSection::require(const char* key) {
  if (table_ != nullptr && !has(key)) note(key, "is missing");
}

void TomlSection::reject_others() {
  if (table_ == nullptr) return;
  for (const auto& [key, value] : *table_)
    if (!known_.contains(key.str())) note(std::string(key.str()), "is not known");
}

}  // namespace bodyscan
