// The edits of a scene as they stand in a session.
#pragma once

#include "render/session_fields.h"

namespace midway {

SessionJson edits_json(const SceneEdits& edits);

// Throws as SessionFields for values out of range and for two edits of one thing.
void read_edits(SessionFields fields, SceneEdits& edits);

}  // namespace midway
