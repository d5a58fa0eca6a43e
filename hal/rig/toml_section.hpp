#pragma once

#include "pipeline/base/image.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

namespace bodyscan {

// Reads one table of a TOML file key by key and notes every problem by the key's full name: "camera.iso: 7 is
// not between 50 and 102400". A value that is missing or wrong stays as it was.
class TomlSection {
 public:
  // `problems` must outlive the section. An empty name is the file itself.
  TomlSection(const toml::table& file, const std::string& name, std::vector<std::string>& problems);

  [[nodiscard]] bool has(const char* key) const { return table_ != nullptr && table_->contains(key); }

  void read(const char* key, std::string& value);
  void read(const char* key, int& value, int least, int most);
  void read(const char* key, double& value, double least, double most);
  // A path from `folder` on, not empty.
  void read(const char* key, std::filesystem::path& value, const std::filesystem::path& folder);
  // [width, height]
  void read(const char* key, Size& value, int most);

  template <class Value, std::size_t count>
  void read(const char* key, Value& value,
            const std::array<std::pair<std::string_view, Value>, count>& choices) {
    const std::optional<std::string> name = text(key);
    if (!name) return;
    std::string known;
    for (const auto& [choice, meaning] : choices) {
      if (choice == *name) {
        value = meaning;
        return;
      }
      known += (known.empty() ? "" : ", ") + std::string(choice);
    }
    note(key, "'" + *name + "' is not known; there are: " + known);
  }

  // Notes a key that is missing from the table, where there is one.
  void require(const char* key);
  // A key that is read elsewhere.
  void expect(const char* key) { known_.insert(key); }
  // Notes every key that was neither read nor expected.
  void reject_others();

 private:
  const toml::node* find(const char* key);
  // Nothing where there is none, or something else, which is noted.
  std::optional<std::string> text(const char* key);
  void note(const std::string& key, const std::string& problem);

  std::string name_;
  const toml::table* table_ = nullptr;
  std::set<std::string, std::less<>> known_;
  std::vector<std::string>& problems_;
};

}  // namespace bodyscan
