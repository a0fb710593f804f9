//! Names and call tips of the functions of `simOMPL`.

/// Gives the names of the functions of [`call`](crate::call()) and their call tips, one after the other, to a macro, as
/// literals.
#[macro_export]
macro_rules! for_functions {
    ($table:ident) => {
        $table! {
            "createStateSpace" "int stateSpaceHandle=simOMPL.createStateSpace(string name,int type,int objectHandle,float[] boundsLow,float[] boundsHigh,int useForProjection=0,float weight=1.0,int refObjectHandle=-1)"
            "destroyStateSpace" "simOMPL.destroyStateSpace(int stateSpaceHandle)"
            "createTask" "int taskHandle=simOMPL.createTask(string name)"
            "destroyTask" "simOMPL.destroyTask(int taskHandle)"
            "printTaskInfo" "string info=simOMPL.printTaskInfo(int taskHandle)"
            "setVerboseLevel" "simOMPL.setVerboseLevel(int taskHandle,int verboseLevel)"
            "setStateValidityCheckingResolution" "simOMPL.setStateValidityCheckingResolution(int taskHandle,float resolution)"
            "setStateSpace" "simOMPL.setStateSpace(int taskHandle,int[] stateSpaceHandles)"
            "getStateSpaceDimension" "int dim=simOMPL.getStateSpaceDimension(int taskHandle)"
            "setAlgorithm" "simOMPL.setAlgorithm(int taskHandle,int algorithm)"
            "setCollisionPairs" "simOMPL.setCollisionPairs(int taskHandle,int[] collisionPairHandles)"
            "setStartState" "simOMPL.setStartState(int taskHandle,float[] state)"
            "setGoalState" "simOMPL.setGoalState(int taskHandle,float[] state)"
            "addGoalState" "simOMPL.addGoalState(int taskHandle,float[] state)"
            "setGoal" "simOMPL.setGoal(int taskHandle,int robotDummy,int goalDummy,float tolerance=0.001,float[4] metric={1.0,1.0,1.0,0.1},int refDummy=-1)"
            "setup" "simOMPL.setup(int taskHandle)"
            "solve" "bool solved=simOMPL.solve(int taskHandle,float maxTime=-1.0)"
            "simplifyPath" "simOMPL.simplifyPath(int taskHandle,float maxSimplificationTime=-1.0)"
            "interpolatePath" "simOMPL.interpolatePath(int taskHandle,int stateCnt=0)"
            "hasSolution" "bool result=simOMPL.hasSolution(int taskHandle)"
            "hasExactSolution" "bool result=simOMPL.hasExactSolution(int taskHandle)"
            "hasApproximateSolution" "bool result=simOMPL.hasApproximateSolution(int taskHandle)"
            "getGoalDistance" "float distance=simOMPL.getGoalDistance(int taskHandle)"
            "getPath" "float[] states=simOMPL.getPath(int taskHandle)"
            "compute" "bool solved,float[] states=simOMPL.compute(int taskHandle,float maxTime,float maxSimplificationTime=-1.0,int stateCnt=0)"
            "readState" "float[] state=simOMPL.readState(int taskHandle)"
            "writeState" "simOMPL.writeState(int taskHandle,float[] state)"
            "isStateValid" "bool valid=simOMPL.isStateValid(int taskHandle,float[] state)"
            "isStateWithinBounds" "bool valid=simOMPL.isStateWithinBounds(int taskHandle,float[] state)"
            "enforceBounds" "float[] state=simOMPL.enforceBounds(int taskHandle,float[] state)"
            "stateDistance" "float distance=simOMPL.stateDistance(int taskHandle,float[] a,float[] b)"
            "getPathStateCount" "int count=simOMPL.getPathStateCount(int taskHandle,float[] path)"
            "getPathState" "float[] state=simOMPL.getPathState(int taskHandle,float[] path,int index)"
            "getReversedPath" "float[] path=simOMPL.getReversedPath(int taskHandle,float[] path)"
            "drawPath" "int[] drawingObjectHandles=simOMPL.drawPath(int taskHandle,float[] path,float lineSize=1.0,float[3] color={1.0,0.0,0.0},int extraAttributes=0)"
            "removeDrawingObjects" "simOMPL.removeDrawingObjects(int taskHandle,int[] drawingObjectHandles)"
        }
    };
}
