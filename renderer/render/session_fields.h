// Reading a session's JSON without believing it: every field is asked for by its name and checked;
// what is wrong throws std::runtime_error with one line that names the field and the file.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "image/file.h"
#include "render/session.h"

namespace midway {

using SessionJson = nlohmann::ordered_json;

[[noreturn]] inline void refuse_session(const std::string& what, const std::string& path) {
    throw std::runtime_error(one_line(what) + " (" + one_line(path) +
                             "); correct it or save the session again");
}

// The fields of one JSON object, each asked for by its name; what nobody asked for is warned of.
class SessionFields {
  public:
    SessionFields(const SessionJson& object, std::string prefix, LoadedSession& out,
                  const std::string& path)
        : object_(object), prefix_(std::move(prefix)), out_(out), path_(path) {
        if (!object.is_object()) bad("", "is not an object");
    }

    const SessionJson* find(const std::string& name) {
        known_.insert(name);
        const auto it = object_.find(name);
        return it == object_.end() ? nullptr : &*it;
    }

    [[noreturn]] void bad(const std::string& name, const std::string& why) const {
        std::string field = prefix_ + name;
        if (!field.empty() && field.back() == '.') field.pop_back();
        refuse_session("session field \"" + field.substr(0, 100) + "\" " + why, path_);
    }

    void read(const std::string& name, std::string& to) {
        const SessionJson* j = find(name);
        if (!j) return;
        if (!j->is_string()) bad(name, "is not a text");
        to = j->get<std::string>();
        if (to.find('\0') != std::string::npos) bad(name, "holds a zero byte");
    }
    void read(const std::string& name, bool& to) {
        const SessionJson* j = find(name);
        if (!j) return;
        if (!j->is_boolean()) bad(name, "is neither true nor false");
        to = j->get<bool>();
    }
    void read(const std::string& name, double& to) {
        if (const SessionJson* j = find(name)) to = number(name, *j);
    }
    void read(const std::string& name, float& to) {
        if (const SessionJson* j = find(name)) to = small_number(name, *j);
    }
    template <class T>
    void read(const std::string& name, std::optional<T>& to) {
        if (!find(name)) return;
        T value{};
        read(name, value);
        to = value;
    }
    template <class T>
    void read_whole(const std::string& name, T& to, T low, T high) {
        if (const SessionJson* j = find(name)) to = whole(name, *j, low, high);
    }

    double number(const std::string& name, const SessionJson& j) const {
        if (!j.is_number() || !std::isfinite(j.get<double>())) bad(name, "is not a finite number");
        return j.get<double>();
    }
    float small_number(const std::string& name, const SessionJson& j) const {
        const auto x = static_cast<float>(number(name, j));
        if (!std::isfinite(x)) bad(name, "is not a finite number");
        return x;
    }
    template <class T>
    T whole(const std::string& name, const SessionJson& j, T low, T high) const {
        const bool fits = j.is_number_unsigned()
                              ? j.get<std::uint64_t>() <= static_cast<std::uint64_t>(high)
                              : j.is_number_integer() && low < 0;
        if (!fits || j.get<T>() < low)
            bad(name, "is not a whole number from " + std::to_string(low) + " to " +
                          std::to_string(high));
        return j.get<T>();
    }
    const SessionJson& list(const std::string& name, const SessionJson& j, size_t least,
                            size_t most) const {
        if (!j.is_array() || j.size() < least || j.size() > most)
            bad(name, "is not a list of the right length");
        return j;
    }
    // The fields of an object inside this one.
    SessionFields inside(const std::string& name, const SessionJson& object) const {
        return {object, prefix_ + name + ".", out_, path_};
    }
    // Turns a word into its meaning; `parse` throws for words it does not know.
    template <class T, class Parse>
    void read_word(const std::string& name, T& to, const Parse& parse) {
        if (!find(name)) return;
        std::string text;
        read(name, text);
        try {
            to = parse(text);
        } catch (const std::exception&) {
            bad(name, "holds a word that is not known: \"" + text.substr(0, 100) + "\"");
        }
    }

    void warn_of_the_rest() {
        for (const auto& [name, value] : object_.items())
            if (!known_.count(name) && out_.warnings.size() < 20)
                out_.warnings.push_back("session field \"" +
                                        one_line(prefix_ + name).substr(0, 100) +
                                        "\" is not known; left out (" + one_line(path_) + ")");
    }

  private:
    const SessionJson& object_;
    std::string prefix_;
    LoadedSession& out_;
    const std::string& path_;
    std::set<std::string> known_;
};

}  // namespace midway
