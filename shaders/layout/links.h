// SPDX-License-Identifier: MIT
#ifndef LODESTONE_LAYOUT_LINKS_H
#define LODESTONE_LAYOUT_LINKS_H

#include "layout/types.h"

LODESTONE_LAYOUT_BEGIN
struct LinksPush {
  uint depth;  // of the nodes whose links are written
  uint leaf_depth;
  uint count;       // nodes on that level
  uint first_node;  // of the hierarchy; links count from it
  uint first_slot;
  uint slots;  // leaf slots in use; those behind are padding
};
LODESTONE_LAYOUT_END
#endif
