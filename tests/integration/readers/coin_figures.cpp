// Prints what Coin finds in a VRML file, as sample_models does; refuses to start in another locale than asked
// for.

#include <algorithm>
#include <clocale>
#include <cstdio>
#include <cstring>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoFullPath.h>
#include <Inventor/SoInput.h>
#include <Inventor/VRMLnodes/SoVRMLColor.h>
#include <Inventor/VRMLnodes/SoVRMLCoordinate.h>
#include <Inventor/VRMLnodes/SoVRMLGroup.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoSearchAction.h>

namespace {

void count_triangle(void* count, SoCallbackAction* /*action*/, const SoPrimitiveVertex* /*a*/,
                    const SoPrimitiveVertex* /*b*/, const SoPrimitiveVertex* /*c*/) {
  ++*static_cast<int*>(count);
}

template <class Node>
Node* find(SoNode* root) {
  SoSearchAction search;
  search.setType(Node::getClassTypeId());
  search.setSearchingAll(TRUE);
  search.apply(root);
  return search.getPath() == nullptr
             ? nullptr
             : static_cast<Node*>(static_cast<SoFullPath*>(search.getPath())->getTail());
}

int run(const char* file) {
  SoDB::init();
  SoInput input;
  if (!input.openFile(file)) return 1;
  SoVRMLGroup* root = SoDB::readAllVRML(&input);
  if (root == nullptr) return 1;
  root->ref();
  int triangles = 0;
  SoCallbackAction faces;
  faces.addTriangleCallback(SoNode::getClassTypeId(), count_triangle, &triangles);
  faces.apply(root);
  SoGetBoundingBoxAction bounds{SbViewportRegion(100, 100)};
  bounds.apply(root);
  const auto* points = find<SoVRMLCoordinate>(root);
  const auto* colors = find<SoVRMLColor>(root);
  const SbVec3f low = bounds.getBoundingBox().getMin();
  const SbVec3f high = bounds.getBoundingBox().getMax();
  std::setlocale(LC_NUMERIC, "C");
  std::printf("%s %d %d %d %.9g %.9g %.9g %.9g %.9g %.9g\n", file,
              points == nullptr ? 0 : points->point.getNum(), triangles,
              colors == nullptr ? 0 : colors->color.getNum(), static_cast<double>(low[0]),
              static_cast<double>(low[1]), static_cast<double>(low[2]), static_cast<double>(high[0]),
              static_cast<double>(high[1]), static_cast<double>(high[2]));
  root->unref();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 || std::setlocale(LC_ALL, "") == nullptr) return 2;
  if (std::strcmp(std::localeconv()->decimal_point, argv[1]) != 0) return 2;
  return run(argv[2]);
}
