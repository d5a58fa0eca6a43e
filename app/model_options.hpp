#pragma once

#include "app/model_files.hpp"
#include "app/model_report.hpp"

#include <string>

namespace CLI {
class App;
}

namespace bodyscan {

// The command line of what every command that makes a model can write.
void add_model_options(CLI::App& command, ModelOptions& options);

// "model.wrl: 1234 points, 2345 faces"
std::string summary(const ModelReport& report, const std::filesystem::path& model);

}  // namespace bodyscan
