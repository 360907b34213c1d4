// The two figures modelled as implicit surfaces, each one solid body standing on y = 0 and facing
// +z.
#pragma once

#include "mesh.h"

namespace midway::assets {

// The head of a monkey idol, about 2.5 units tall and 3 wide over the ears, on a short flared neck.
Mesh idol_head(double cell);

// A teapot about one unit tall, spout towards +x.
Mesh teapot(double cell);

}  // namespace midway::assets
