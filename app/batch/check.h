// midway check: the numerical audit of a scene, or the built-in extreme suite.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "commands.h"
#include "report/audit.h"

namespace midway {

struct CheckCommand {
    SceneOptions scene;   // no path: the suite
    std::string session;  // where the scene's wishes came from one
    RenderSettings settings;
    AuditOptions audit;
    std::optional<std::string> report;  // HTML file
    std::string only;                   // GROUP or GROUP/CASE of the suite
    double effort = 1;
    std::string assets;  // folder of the project's scenes, for the suite
    bool json = false, quiet = false;
};

// Both return the exit status.
int check_scene(const CheckCommand& command);
int check_suite(const CheckCommand& command);

// The command that computes the sample at fault again.
std::string replay_command(const CheckCommand& command, const AuditPlace& place);
std::string check_command_line(const CheckCommand& command);

void print_audit(const CheckCommand& command, const AuditResult& result);
nlohmann::ordered_json audit_json(const CheckCommand& command, const AuditResult& result);

}  // namespace midway
