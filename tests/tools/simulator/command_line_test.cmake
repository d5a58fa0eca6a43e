# The exit status and the message of wrong command lines.
function(expect status message)
  execute_process(COMMAND ${PROGRAM} ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(NOT result EQUAL status OR NOT "${output}${error}" MATCHES "${message}")
    message(SEND_ERROR "${ARGN}: status ${result}, wanted ${status} and \"${message}\": ${output}${error}")
  endif()
endfunction()

set(spheres --subject builtin:spheres --calibration builtin:rows --output never-written)
expect(2 "subcommand")
expect(0 "75 degrees" render --help)
expect(2 "--subject" render --calibration builtin:rows --output never-written)
expect(2 "--rays: must lie in 1 to 8" render ${spheres} --rays 9)
expect(2 "--projector: must lie" render ${spheres} --projector 1024)
expect(2 "--pose" render ${spheres} --pose 1,2,3)
expect(2 "--axes" render ${spheres} --axes diagonal)
expect(2 "--patterns" render ${spheres} --patterns slow)
expect(2 "--frame-format" render ${spheres} --frame-format tiff)
expect(2 "--subject: no built-in \"cube\"" render --subject builtin:cube --calibration builtin:rows --output never-written)
expect(2 "--calibration: no built-in rig \"left\"" render --subject builtin:spheres --calibration builtin:left
       --output never-written)
expect(3 "missing.yml" render --subject builtin:spheres --calibration missing.yml --output never-written)
expect(3 "missing.obj: cannot be read" render --subject missing.obj --calibration builtin:rows --output never-written)
expect(2 "--scale: must lie" rig --scale 0 --output never-written.yml)

set(session calibration --output never-written)
expect(2 "--output is required" calibration)
expect(2 "--poses: must lie in 1 to 14" ${session} --poses 15)
expect(2 "--columns: must lie in 3 to 50" ${session} --columns 2)
expect(2 "--rows: must lie" ${session} --rows 51)
expect(2 "--square-mm: must lie" ${session} --square-mm 0)
expect(2 "--bend: must lie in -30 to 30" ${session} --bend 31)
expect(2 "--plate: must lie" ${session} --plate -1)
expect(2 "--projected-share: must lie in 0.1 to 1" ${session} --projected-share 0.05)
expect(2 "--uneven-light: must lie" ${session} --uneven-light 2)
expect(2 "--lens-blur: must lie" ${session} --lens-blur -1)
expect(2 "--method" ${session} --method stripes)
expect(2 "--blunder: \"3:fire\" is no POSE:KIND .kinds: cut, moved," ${session} --blunder 0:cut,3:fire)
expect(2 "--blunder: there is no pose 7 .0 to 6" ${session} --blunder 7:cut)
expect(2 "do not both see the whole board of pose 0" ${session} --square-mm 60 --method gray)
expect(2 "--calibration: no built-in rig \"left\"" ${session} --calibration builtin:left)
expect(3 "missing.yml" ${session} --calibration missing.yml)
foreach(listed --calibration --output --columns --rows --square-mm --bend --plate --projected-share --method --poses
        --blunder --scale --projector --projector-roll --light --contrast --ambient --reflection --defocus --uneven-light
        --subsurface --subsurface-blur --rays --lens-blur --full-well --read-noise --seed --frame-format --jpeg-quality
        gray projected mixed cut moved blurred size scaled dark overexposed "truth/session.json")
  expect(0 "[ ,{(]${listed}[ ,})]" calibration --help)
endforeach()

set(serve serve --subject builtin:staircase --calibration builtin:rows --projector never-listening)
expect(2 "--projector is required" serve --subject builtin:staircase --calibration builtin:rows)
expect(2 "--subject is required" serve --calibration builtin:rows --projector never-listening)
expect(2 "--port: must lie in 0 to 65535" ${serve} --port 65536)
expect(2 "--latency-ms: must lie" ${serve} --latency-ms -1)
expect(2 "--rise-ms: must lie" ${serve} --rise-ms -1)
expect(2 "--prepare" ${serve} --prepare diagonal)
expect(2 "--fault: \"fire@2\": no such fault .there are: slow, dial, frozen@SHOT," ${serve} --fault fire@2)
expect(2 "--fault: \"stale@1\": the shot must be a whole number from 2 on" ${serve} --fault slow --fault stale@1)
expect(2 "--projector-size: must lie in 16x16" ${serve} --projector-size 8x8)
expect(2 "--subject: no built-in \"cube\"" serve --subject builtin:cube --calibration builtin:rows
       --projector never-listening)
expect(3 "missing.yml" serve --subject builtin:staircase --calibration missing.yml --projector never-listening)
expect(3 "--projector: no-folder/socket: No such file" serve --subject builtin:staircase --calibration builtin:rows
       --scale 0.02 --projector no-folder/socket)
foreach(listed --subject --material --scale-subject --pose --detail --calibration --projector --latency-ms --rise-ms --port
        --prepare --fault --scale --projector-size --projector-roll --light --contrast --ambient --reflection --defocus
        --uneven-light --subsurface --subsurface-blur --rays --lens-blur --full-well --read-noise --seed --jpeg-quality
        frozen-for-good@SHOT move=MM@SHOT projector-mode@SHOT)
  expect(0 "[ ,{(]${listed}[ ,;})\n]" serve --help)
endforeach()

# Options reach the renderer.
file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH})
expect(0 "" rig --name columns --scale 0.0625 --projector 64x48 --projector-roll 10 --output ${SCRATCH}/rig.yml)
expect(0 "" render --subject builtin:staircase --calibration ${SCRATCH}/rig.yml --output ${SCRATCH}/capture
       --pose 1,2,3,4,5,6 --motion 0.5,0,0.25 --axes both --no-inverses --frame-format png --no-mesh --material skin
       --light 0.9 --contrast 300 --ambient 0.01 --reflection 0.02 --defocus 0.7 --subsurface 0.4 --subsurface-blur 2
       --rays 1 --full-well 20000 --read-noise 9 --seed 7 --jpeg-quality 80 --scale-subject 0.9 --detail 2)
file(READ ${SCRATCH}/capture/truth/scene.json scene)
string(REGEX REPLACE "[ \n]" "" scene "${scene}")
foreach(wanted "pose_rotation_degrees\":.1.0,2.0,3.0" "pose_translation_mm\":.4.0,5.0,6.0"
        "motion_mm_per_frame\":.0.5,0.0,0.25" "rows\":true" "columns\":true" "inverses\":false" "material\":\"skin"
        "light\":0.9" "contrast\":300" "ambient\":0.01" "reflection\":0.02" "defocus_px\":0.7" "subsurface\":0.4"
        "subsurface_blur_px\":2.0" "rays\":1," "full_well_electrons\":20000" "read_noise_electrons\":9" "seed\":7"
        "jpeg_quality\":80" "subject_scale\":0.9" "detail_mm\":2.0" "frame_format\":\"png")
  if(NOT scene MATCHES "${wanted}")
    message(SEND_ERROR "scene.json lacks ${wanted}")
  endif()
endforeach()
file(GLOB frames ${SCRATCH}/capture/frame_*.png)
list(LENGTH frames count)
if(NOT count EQUAL 14 OR EXISTS ${SCRATCH}/capture/truth/mesh.obj)
  message(SEND_ERROR "${count} frames, wanted 14 and no mesh")
endif()

expect(0 "" calibration --calibration builtin:diagonal --output ${SCRATCH}/session --scale 0.0625 --projector 64x48
       --projector-roll 5 --columns 8 --rows 6 --square-mm 24 --bend 5 --plate 300 --projected-share 0.9 --method projected
       --poses 2 --blunder 0:cut,1:dark --blunder 1:scaled --light 0.7 --contrast 300 --ambient 0.01 --reflection 0.02
       --defocus 0.6 --uneven-light 0.2 --subsurface 0.1 --subsurface-blur 2 --rays 1 --lens-blur 0.5 --full-well 20000
       --read-noise 9 --seed 7 --frame-format png --jpeg-quality 80)
file(READ ${SCRATCH}/session/truth/session.json session)
string(REGEX REPLACE "[ \n]" "" session "${session}")
foreach(wanted "calibration\":\"builtin:diagonal" "rig_scale\":0.0625" "rig_projector\":.64,48" "roll_degrees\":5.0"
        "blunders\":.\"cut\"." "blunders\":.\"dark\",\"scaled\"." "columns\":8,\"rows\":6,\"square_mm\":24.0" "square_mm\":24.96"
        "method\":\"projected\"" "bend_mm\":5.0" "plate_mm\":300.0" "projected_share\":0.9" "light\":0.7" "contrast\":300"
        "ambient\":0.01" "reflection\":0.02" "defocus_px\":0.6" "uneven_light\":0.2" "subsurface\":0.1"
        "subsurface_blur_px\":2.0" "rays\":1," "lens_blur_px\":0.5" "full_well_electrons\":20000"
        "read_noise_electrons\":9" "seed\":7" "frame_format\":\"png" "jpeg_quality\":80")
  if(NOT session MATCHES "${wanted}")
    message(SEND_ERROR "truth/session.json lacks ${wanted}")
  endif()
endforeach()
file(GLOB pictures RELATIVE ${SCRATCH}/session ${SCRATCH}/session/pose_*)
if(NOT pictures STREQUAL "pose_0_printed.png;pose_0_projected.png;pose_1_printed.png;pose_1_projected.png")
  message(SEND_ERROR "the session has ${pictures}")
endif()
file(REMOVE_RECURSE ${SCRATCH})

if(EXISTS never-written OR EXISTS never-listening)
  message(SEND_ERROR "a refused command wrote its output")
endif()
