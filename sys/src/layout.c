/* What the C compiler says about every structure that crosses the boundary, for tests/layout.rs to compare. */

#include "shim.h"

#include <stdalign.h>
#include <stddef.h>

struct EmbreeLayout
{
  const char* name; /* "Type" or "Type.field" */
  size_t size;
  size_t align_or_offset;
};

#define TYPE(T) {#T, sizeof(struct T), alignof(struct T)}
#define ALIAS(T) {#T, sizeof(T), alignof(T)}
#define FIELD(T, F) {#T "." #F, sizeof(((struct T*)0)->F), offsetof(struct T, F)}
#define ALIAS_FIELD(T, F) {#T "." #F, sizeof(((T*)0)->F), offsetof(T, F)}

#define RAY(T)                                                                                                         \
  TYPE(T), FIELD(T, org_x), FIELD(T, org_y), FIELD(T, org_z), FIELD(T, tnear), FIELD(T, dir_x), FIELD(T, dir_y),       \
      FIELD(T, dir_z), FIELD(T, time), FIELD(T, tfar), FIELD(T, mask), FIELD(T, id), FIELD(T, flags)
#define HIT(T)                                                                                                         \
  TYPE(T), FIELD(T, Ng_x), FIELD(T, Ng_y), FIELD(T, Ng_z), FIELD(T, u), FIELD(T, v), FIELD(T, primID),                 \
      FIELD(T, geomID), FIELD(T, instID)
#define RAYHIT(T) TYPE(T), FIELD(T, ray), FIELD(T, hit)

const struct EmbreeLayout embree_layouts[] = {
    RAY(RTCRay), RAY(RTCRay4), RAY(RTCRay8), RAY(RTCRay16),
    HIT(RTCHit), HIT(RTCHit4), HIT(RTCHit8), HIT(RTCHit16),
    RAYHIT(RTCRayHit), RAYHIT(RTCRayHit4), RAYHIT(RTCRayHit8), RAYHIT(RTCRayHit16),
    TYPE(RTCBounds),
    FIELD(RTCBounds, lower_x), FIELD(RTCBounds, lower_y), FIELD(RTCBounds, lower_z),
    FIELD(RTCBounds, upper_x), FIELD(RTCBounds, upper_y), FIELD(RTCBounds, upper_z),
    TYPE(RTCQuaternionDecomposition),
    FIELD(RTCQuaternionDecomposition, scale_x), FIELD(RTCQuaternionDecomposition, scale_y),
    FIELD(RTCQuaternionDecomposition, scale_z), FIELD(RTCQuaternionDecomposition, skew_xy),
    FIELD(RTCQuaternionDecomposition, skew_xz), FIELD(RTCQuaternionDecomposition, skew_yz),
    FIELD(RTCQuaternionDecomposition, shift_x), FIELD(RTCQuaternionDecomposition, shift_y),
    FIELD(RTCQuaternionDecomposition, shift_z), FIELD(RTCQuaternionDecomposition, quaternion_r),
    FIELD(RTCQuaternionDecomposition, quaternion_i), FIELD(RTCQuaternionDecomposition, quaternion_j),
    FIELD(RTCQuaternionDecomposition, quaternion_k), FIELD(RTCQuaternionDecomposition, translation_x),
    FIELD(RTCQuaternionDecomposition, translation_y), FIELD(RTCQuaternionDecomposition, translation_z),
    TYPE(RTCBoundsFunctionArguments),
    FIELD(RTCBoundsFunctionArguments, geometryUserPtr), FIELD(RTCBoundsFunctionArguments, primID),
    FIELD(RTCBoundsFunctionArguments, timeStep), FIELD(RTCBoundsFunctionArguments, bounds_o),
    TYPE(RTCIntersectFunctionNArguments),
    FIELD(RTCIntersectFunctionNArguments, valid), FIELD(RTCIntersectFunctionNArguments, geometryUserPtr),
    FIELD(RTCIntersectFunctionNArguments, primID), FIELD(RTCIntersectFunctionNArguments, context),
    FIELD(RTCIntersectFunctionNArguments, rayhit), FIELD(RTCIntersectFunctionNArguments, N),
    FIELD(RTCIntersectFunctionNArguments, geomID),
    TYPE(RTCOccludedFunctionNArguments),
    FIELD(RTCOccludedFunctionNArguments, valid), FIELD(RTCOccludedFunctionNArguments, geometryUserPtr),
    FIELD(RTCOccludedFunctionNArguments, primID), FIELD(RTCOccludedFunctionNArguments, context),
    FIELD(RTCOccludedFunctionNArguments, ray), FIELD(RTCOccludedFunctionNArguments, N),
    FIELD(RTCOccludedFunctionNArguments, geomID),
    TYPE(RTCFilterFunctionNArguments),
    FIELD(RTCFilterFunctionNArguments, valid), FIELD(RTCFilterFunctionNArguments, geometryUserPtr),
    FIELD(RTCFilterFunctionNArguments, context), FIELD(RTCFilterFunctionNArguments, ray),
    FIELD(RTCFilterFunctionNArguments, hit), FIELD(RTCFilterFunctionNArguments, N),
    ALIAS(EmbreeContext), ALIAS_FIELD(EmbreeContext, instID),
    ALIAS(EmbreeQuery),
    ALIAS_FIELD(EmbreeQuery, context), ALIAS_FIELD(EmbreeQuery, user), ALIAS_FIELD(EmbreeQuery, filter),
    ALIAS_FIELD(EmbreeQuery, coherent),
};

const size_t embree_layout_count = sizeof(embree_layouts) / sizeof(embree_layouts[0]);
