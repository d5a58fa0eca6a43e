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
expect(2 "--frame-format" render ${spheres} --frame-format tiff)
expect(2 "--subject: no built-in \"cube\"" render --subject builtin:cube --calibration builtin:rows --output never-written)
expect(2 "--calibration: no built-in rig \"left\"" render --subject builtin:spheres --calibration builtin:left
       --output never-written)
expect(3 "missing.yml" render --subject builtin:spheres --calibration missing.yml --output never-written)
expect(3 "missing.obj: cannot be read" render --subject missing.obj --calibration builtin:rows --output never-written)
expect(2 "--scale: must lie" rig --scale 0 --output never-written.yml)
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
file(REMOVE_RECURSE ${SCRATCH})

if(EXISTS never-written)
  message(SEND_ERROR "a refused command wrote its output")
endif()
