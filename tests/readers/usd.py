"""What Pixar's USD makes of a .usda or .usdz: the lowest point and the volume of each ball at given times, in metres."""
import json
import math
import sys

from pxr import Usd, UsdGeom, UsdValidation

path, times = sys.argv[1], json.loads(sys.argv[2])
stage = Usd.Stage.Open(path)
up, metres = "XYZ".index(UsdGeom.GetStageUpAxis(stage)), UsdGeom.GetStageMetersPerUnit(stage)
fps, first = stage.GetTimeCodesPerSecond(), stage.GetStartTimeCode()
balls = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Sphere)]


def shown(ball, t):
    world = UsdGeom.Xformable(ball).ComputeLocalToWorldTransform(Usd.TimeCode(first + t * fps))
    # Row vectors: a place is p M.
    reach = UsdGeom.Sphere(ball).GetRadiusAttr().Get() * math.sqrt(sum(world[k][up] ** 2 for k in range(3)))
    return [metres * (world[3][up] - reach), world.GetDeterminant()]


rows = [[shown(ball, t) for ball in balls] for t in times]
registry = UsdValidation.ValidationRegistry()
found = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators()).Validate(stage)
issues = ["%s: %s" % (error.GetName(), error.GetMessage()) for error in found]
wrong = [error for error in found if error.GetType() == UsdValidation.ValidationErrorType.Error]
name = "USD %d.%d" % Usd.GetVersion()[1:]
print(json.dumps({"issues": issues, "errors": len(wrong), "animations": {name: rows}}))
